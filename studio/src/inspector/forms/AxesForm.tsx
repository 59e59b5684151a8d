// Several of the document's axes, in order.

import { MultiSelect } from "@mantine/core";
import { useState } from "react";

import { useStudio } from "../../store";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { NewAxis } from "../axes/NewAxis";
import { AxisLines, axisOption, NEW_AXIS } from "./AxisLines";
import type { FormProps } from "./props";

export function AxesForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting<unknown>(element, path, value, form.cost);
  const axes = useStudio((state) => state.document?.axes) ?? [];
  const keys = (value ?? []) as string[];
  const options = [...axes.map(axisOption), NEW_AXIS];
  const [adding, setAdding] = useState(false);
  return (
    <ParameterRow form={form} path={path} value={value} onReset={(standard) => void setting.commit(standard)}>
      <MultiSelect
        className="grow"
        size="xs"
        aria-label={path}
        data={options.map(({ value: key, label }) => ({
          value: key,
          label: keys.includes(key) ? key : label,
        }))}
        value={keys}
        placeholder={keys.length > 0 ? undefined : "none: a node"}
        hidePickedOptions
        comboboxProps={{ shadow: "md" }}
        onChange={(next) => (next.includes(NEW_AXIS.value) ? setAdding(true) : void setting.commit(next))}
      />
      {adding && (
        <NewAxis
          axes={axes}
          onMake={(axis) => setting.commit([...keys, axis])}
          onDone={() => setAdding(false)}
        />
      )}
      <AxisLines axes={keys.flatMap((key) => axes.find((axis) => axis.key === key) ?? [])} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
