// What axes are: name, range, samples; a click on a line opens its fields.

import { Popover, UnstyledButton } from "@mantine/core";

import type { AxisView } from "../../protocol";
import { AxisFields } from "../axes/AxisFields";
import { numberText } from "../../widgets/number";

export function AxisLines({ axes }: { axes: AxisView[] }) {
  return (
    <ul className="axis-lines">
      {axes.map((axis) => (
        <li key={axis.key}>
          <Popover position="left-start" width={230} shadow="md" trapFocus>
            <Popover.Target>
              <UnstyledButton className="axis-line" title={`Edit the axis ${axis.name}`}>
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
