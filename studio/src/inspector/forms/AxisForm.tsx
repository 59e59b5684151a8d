// One of the document's axes.

import { useState } from "react";

import { useStudio } from "../../store";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { NewAxis } from "../axes/NewAxis";
import { AxisLines, axisOption, NEW_AXIS } from "./AxisLines";
import { ChoiceBox } from "./ChoiceBox";
import type { FormProps } from "./props";

export function AxisForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting<unknown>(element, path, value, form.cost);
  const axes = useStudio((state) => state.document?.axes) ?? [];
  const [adding, setAdding] = useState(false);
  const key = typeof value === "string" ? value : null;
  return (
    <ParameterRow form={form} path={path} value={value} onReset={(standard) => void setting.commit(standard)}>
      <ChoiceBox
        label={path}
        value={key}
        choices={[...axes.map(axisOption), NEW_AXIS]}
        optional={form.optional}
        onCommit={(chosen) => (chosen === NEW_AXIS.value ? setAdding(true) : void setting.commit(chosen))}
      />
      {adding && <NewAxis axes={axes} onMake={setting.commit} onDone={() => setAdding(false)} />}
      <AxisLines axes={axes.filter((axis) => axis.key === key)} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
