// Any value: a number, true or false, a list, or else text.

import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import type { FormProps } from "./props";
import { TextBox } from "./TextBox";
import { typedValue, valueText } from "./value";

export function ValueForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  return (
    <ParameterRow
      form={form}
      path={path}
      value={value}
      inline
      onReset={(standard) => void setting.commit(standard)}
    >
      <TextBox
        label={path}
        value={valueText(value)}
        rejected={setting.problem !== null}
        onCommit={(typed) => setting.commit(typedValue(typed))}
        onForget={setting.forget}
      />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
