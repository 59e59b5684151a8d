// A part of a kind that can be chosen, with its own parameters below.

import { useStudio } from "../../store";
import { kindOf, recast } from "../parameters/part";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { ChoiceBox } from "./ChoiceBox";
import { PartFields } from "./PartFields";
import type { FormProps } from "./props";

export function PartForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const kinds = useStudio((state) => state.kinds);
  const kind = kindOf(kinds, value);
  const choices = form.of.map((name) => ({ value: name, label: kinds.get(name)?.title ?? name }));
  const choose = (name: string | null) =>
    void setting.commit(name === null ? null : recast(kinds, name, value));
  return (
    <>
      <ParameterRow
        form={form}
        path={path}
        value={value}
        inline
        onReset={(standard) => void setting.commit(standard)}
      >
        <ChoiceBox
          label={path}
          value={kind?.name ?? null}
          choices={choices}
          optional={form.optional}
          onCommit={choose}
        />
        <ProblemLine problem={setting.problem} />
      </ParameterRow>
      {kind !== undefined && (
        <div className="nested">
          <PartFields kind={kind.name} values={value} prefix={`${path}.`} />
        </div>
      )}
    </>
  );
}
