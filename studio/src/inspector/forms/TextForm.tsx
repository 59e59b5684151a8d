// Text, or one of a few words.

import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { ChoiceBox } from "./ChoiceBox";
import { NameBox } from "./NameBox";
import type { FormProps } from "./props";
import { TextBox } from "./TextBox";

export function TextForm({ form, path, value }: FormProps) {
  const { element, names } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const text = typeof value === "string" ? value : null;
  const known = names?.(form.names ?? "") ?? [];
  const few = form.choices.length > 0;
  return (
    <ParameterRow
      form={form}
      path={path}
      value={value}
      inline={few}
      onReset={(standard) => void setting.commit(standard)}
    >
      {few ? (
        <ChoiceBox
          label={path}
          value={text}
          choices={form.choices}
          optional={form.optional}
          onCommit={(chosen) => void setting.commit(chosen)}
        />
      ) : known.length > 0 ? (
        <NameBox
          label={path}
          value={text ?? ""}
          names={known}
          onCommit={(typed) => setting.commit(typed === "" && form.optional ? null : typed)}
        />
      ) : (
        <TextBox
          label={path}
          value={text ?? ""}
          placeholder={form.optional ? "none" : undefined}
          rejected={setting.problem !== null}
          onCommit={(typed) => setting.commit(typed === "" && form.optional ? null : typed)}
          onForget={setting.forget}
        />
      )}
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
