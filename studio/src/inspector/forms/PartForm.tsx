// A part of a kind that can be chosen, with its own parameters below.

import { useStudio } from "../../store";
import { kindOf, recast } from "../parameters/part";
import { ChoiceBox } from "./ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import { PartFields } from "./PartFields";
import type { FormProps } from "./props";

export function PartForm(props: FormProps) {
  const { form, path, value } = props;
  const setting = useForm(props);
  const kinds = useStudio((state) => state.kinds);
  const kind = kindOf(kinds, value);
  return (
    <>
      <FormRow {...props} setting={setting} inline>
        <ChoiceBox
          label={path}
          value={kind?.name ?? null}
          choices={form.of.map((name) => ({ value: name, label: kinds.get(name)?.title ?? name }))}
          optional={form.optional}
          onCommit={(name) => void setting.commit(name === null ? null : recast(kinds, name, value))}
        />
      </FormRow>
      {kind !== undefined && (
        <div className="nested">
          <PartFields kind={kind.name} values={value} prefix={`${path}.`} />
        </div>
      )}
    </>
  );
}
