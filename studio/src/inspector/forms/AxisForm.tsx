// One of the document's axes.

import { useStudio } from "../../store";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { AxisLines, axisOption } from "./AxisLines";
import { ChoiceBox } from "./ChoiceBox";
import type { FormProps } from "./props";

export function AxisForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const axes = useStudio((state) => state.document?.axes) ?? [];
  const key = typeof value === "string" ? value : null;
  return (
    <ParameterRow form={form} path={path} value={value} onReset={(standard) => void setting.commit(standard)}>
      <ChoiceBox
        label={path}
        value={key}
        choices={axes.map(axisOption)}
        optional={form.optional}
        onCommit={(chosen) => void setting.commit(chosen)}
      />
      <AxisLines axes={axes.filter((axis) => axis.key === key)} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
