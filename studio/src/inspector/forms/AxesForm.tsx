// One of the document's axes, or several in order.

import { MultiSelect } from "@mantine/core";
import { type ReactNode, useState } from "react";

import type { AxisProperties } from "../../model/elementAxes";
import { useStudio } from "../../store";
import { NewAxis } from "../axes/NewAxis";
import { AxisLines, axisOption, NEW_AXIS } from "./AxisLines";
import { ChoiceBox } from "./ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import type { FormProps } from "./props";

export function AxesForm(props: FormProps) {
  const keys = (props.value ?? []) as string[];
  return (
    <AxisRow {...props} keys={keys} including={(axis) => [...keys, axis]}>
      {(options, choose) => (
        <MultiSelect
          className="grow"
          size="xs"
          aria-label={props.path}
          data={options.map(({ value, label }) => ({ value, label: keys.includes(value) ? value : label }))}
          value={keys}
          placeholder={keys.length > 0 ? undefined : "none: a node"}
          hidePickedOptions
          comboboxProps={{ shadow: "md" }}
          onChange={choose}
        />
      )}
    </AxisRow>
  );
}

export function AxisForm(props: FormProps) {
  const key = typeof props.value === "string" ? props.value : null;
  return (
    <AxisRow {...props} keys={key === null ? [] : [key]} including={(axis) => axis}>
      {(choices, choose) => (
        <ChoiceBox
          label={props.path}
          value={key}
          choices={choices}
          optional={props.form.optional}
          onCommit={choose}
        />
      )}
    </AxisRow>
  );
}

type AxisRowProps = FormProps & {
  keys: string[];
  // The value with a new axis.
  including: (axis: AxisProperties) => unknown;
  children: (options: (typeof NEW_AXIS)[], choose: (next: string[] | string | null) => void) => ReactNode;
};

function AxisRow({ keys, including, children, ...props }: AxisRowProps) {
  const setting = useForm(props);
  const axes = useStudio((state) => state.document?.axes) ?? [];
  const [adding, setAdding] = useState(false);
  const choose = (next: string[] | string | null) =>
    [next].flat().includes(NEW_AXIS.value) ? setAdding(true) : void setting.commit(next);
  return (
    <FormRow {...props} setting={setting}>
      {children([...axes.map(axisOption), NEW_AXIS], choose)}
      {adding && (
        <NewAxis
          axes={axes}
          onMake={(axis) => setting.commit(including(axis))}
          onDone={() => setAdding(false)}
        />
      )}
      <AxisLines axes={keys.flatMap((key) => axes.find((axis) => axis.key === key) ?? [])} />
    </FormRow>
  );
}
