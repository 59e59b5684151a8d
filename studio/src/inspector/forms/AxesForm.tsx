// Several of the document's axes, in order.

import { MultiSelect } from "@mantine/core";

import { useStudio } from "../../store";
import { usePlace } from "../place";
import { ProblemLine } from "../../widgets/ProblemLine";
import { ParameterRow } from "../parameters/ParameterRow";
import { useSetting } from "../parameters/setting";
import { AxisLines, axisOption } from "./AxisLines";
import type { FormProps } from "./props";

export function AxesForm({ form, path, value }: FormProps) {
  const { element } = usePlace();
  const setting = useSetting(element, path, value, form.cost);
  const axes = useStudio((state) => state.document?.axes) ?? [];
  const keys = (value ?? []) as string[];
  const options = axes.map(axisOption);
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
        placeholder={
          keys.length > 0 ? undefined : options.length > 0 ? "none: a node" : "the document has no axes"
        }
        hidePickedOptions
        disabled={options.length === 0}
        comboboxProps={{ shadow: "md" }}
        onChange={(next) => void setting.commit(next)}
      />
      <AxisLines axes={keys.flatMap((key) => axes.find((axis) => axis.key === key) ?? [])} />
      <ProblemLine problem={setting.problem} />
    </ParameterRow>
  );
}
