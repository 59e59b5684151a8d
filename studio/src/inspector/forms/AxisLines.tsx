// What axes are: name, range, samples; a click on a line opens its fields.

import { Popover, UnstyledButton } from "@mantine/core";

import type { AxisView } from "../../protocol";
import { AxisFields } from "../axes/AxisFields";
import { numberText } from "../numbers/number";

export function AxisLines({ axes }: { axes: AxisView[] }) {
  return (
    <ul className="axis-lines">
      {axes.map((axis) => (
        <li key={axis.key}>
          <Popover position="left-start" width={230} shadow="md" trapFocus>
            <Popover.Target>
              <UnstyledButton className="axis-line" title={`Edit the axis ${axis.name}`}>
                <b className="one-line" title={axis.name}>
                  {axis.name}
                </b>
                <span>
                  {numberText(axis.lower)} to {numberText(axis.upper)} {axis.unit}
                </span>
                <span className="dim">
                  {axis.samples} samples{axis.periodic ? ", periodic" : ""}
                </span>
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

// An axis in a list to choose from.
export function axisOption(axis: AxisView): { value: string; label: string } {
  const name = axis.key === axis.name ? axis.key : `${axis.key} (${axis.name})`;
  return {
    value: axis.key,
    label: `${name}: ${numberText(axis.lower)} to ${numberText(axis.upper)} ${axis.unit}`.trim(),
  };
}
