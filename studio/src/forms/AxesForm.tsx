// One of the document's axes, or several in order, and what they are: name, range, samples; a click on a line
// opens its fields.

import { MultiSelect, Popover, UnstyledButton } from "@mantine/core";
import { type ReactNode, useState } from "react";

import type { AxisProperties } from "../model/elementAxes";
import { useStudio } from "../server/store";
import { NewAxis } from "./NewAxis";
import { ChoiceBox } from "../widgets/ChoiceBox";
import { FormRow, useForm } from "./FormRow";
import type { FormProps } from "./props";
import type { AxisView } from "../protocol";
import { AxisFields } from "./AxisFields";
import { numberText } from "../model/number";

export function AxesForm(props: FormProps) {
  const keys = (props.value ?? []) as string[];
  return (
    <AxisRow {...props} keys={keys} including={(axis) => [...keys, axis]}>
      {(options, choose) => (
        <MultiSelect
          className="grow"
          aria-label={props.path}
          data={options.map(({ value, label }) => ({ value, label: keys.includes(value) ? value : label }))}
          value={keys}
          placeholder={keys.length > 0 ? undefined : "none: a node"}
          hidePickedOptions
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

export function AxisLines({ axes }: { axes: AxisView[] }) {
  return (
    <ul className="axis-lines">
      {axes.map((axis) => (
        <li key={axis.key}>
          <Popover position="left-start" width={230} trapFocus>
            <Popover.Target>
              <UnstyledButton className="flow axis-line" title={`Edit the axis ${axis.name}`}>
                <b className="one-line" title={axis.name}>
                  {calledAxis(axis)}
                </b>
                <span>{rangeText(axis)}</span>
                <span className="dim">{samplesText(axis)}</span>
              </UnstyledButton>
            </Popover.Target>
            <Popover.Dropdown>
              <AxisFields axis={axis} />
            </Popover.Dropdown>
          </Popover>
        </li>
      ))}
    </ul>
  );
}

// An axis in a list to choose from: two of one name differ by key, and in the range or the samples.
export function axisOption(axis: AxisView): { value: string; label: string } {
  return { value: axis.key, label: `${calledAxis(axis)}: ${rangeText(axis)}, ${samplesText(axis)}` };
}

const calledAxis = ({ key, name }: AxisView): string => (key === name ? key : `${key} (${name})`);

const rangeText = ({ lower, upper, unit }: AxisView): string =>
  `${numberText(lower)} to ${numberText(upper)} ${unit}`.trim();

const samplesText = ({ samples, periodic }: AxisView): string =>
  `${samples} samples${periodic ? ", periodic" : ""}`;

// The last entry of lists of axes.
export const NEW_AXIS = { value: "+", label: "+ New axis" };
