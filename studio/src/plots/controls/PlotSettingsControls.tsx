// The controls of a plot, those that its kind names.

import { Checkbox, SegmentedControl, Text } from "@mantine/core";
import type { Range } from "../../draw/scale";
import type { Announced } from "../../protocol";
import type { ControlName, Shown } from "../kinds/kind";
import { axesOf } from "../kinds/parts";
import { allAxes } from "../section";
import type { PlotSettings } from "../settings";
import { traceOf } from "../traces";
import { AxisControl } from "./AxisControl";
import { ColorControl } from "./ColorControl";
import { PushControl } from "./PushControl";
import { RangeControl } from "./RangeControl";
import { TraceAdding } from "./TraceAdding";
import { TraceControl } from "./TraceControl";
import { WindowControl } from "./WindowControl";

type ControlsProps = {
  names: readonly ControlName[];
  // What the axes are called that can be exchanged.
  sides: readonly string[];
  shown: Shown;
  form: Announced | null;
  // The range that is shown now.
  range: () => Range;
  amplitude: number;
  set: (settings: Partial<PlotSettings>) => void;
};

export function PlotSettingsControls({ names, sides, shown, form, range, amplitude, set }: ControlsProps) {
  const { element, settings } = shown;
  const has = (name: ControlName) => names.includes(name);
  return (
    <>
      {has("drawn") && <AxisControl axes={allAxes(form)} labels={[...sides]} set={set} />}
      {has("window") && <WindowControl window={settings.window} set={(window) => set({ window })} />}
      {has("down") && (
        <SegmentedControl
          size="xs"
          fullWidth
          aria-label="Direction of time"
          data={[
            { value: "right", label: "time to the right" },
            { value: "down", label: "time down" },
          ]}
          value={settings.down ? "down" : "right"}
          onChange={(value) => set({ down: value === "down" })}
        />
      )}
      {has("scale") && <ColorControl scale={settings.scale} set={(scale) => set({ scale })} />}
      {has("range") && (
        <RangeControl range={settings.range} shown={range} set={(next) => set({ range: next })} />
      )}
      {has("push") && element.pushable && (
        <PushControl amplitude={amplitude} width={settings.width} set={set} />
      )}
      {has("traces") && <TraceAdding first={ownTrace(shown)} traces={settings.traces} set={set} />}
      {has("trajectory") && <TrajectoryControls shown={shown} set={set} />}
    </>
  );
}

// The time course of the port itself.
function ownTrace(shown: Shown) {
  return traceOf(shown.element.id, shown.port, axesOf(shown), "max");
}

// The time courses of a phase plot.
function TrajectoryControls({ shown, set }: Pick<ControlsProps, "shown" | "set">) {
  const { up } = shown.settings;
  const across = shown.settings.across ?? ownTrace(shown);
  return (
    <>
      <div className="plot-more">
        <Text size="xs" fw={500}>
          To the right
        </Text>
        <TraceControl trace={across} label="the horizontal axis" set={(next) => set({ across: next })} />
      </div>
      <div className="plot-more">
        <Text size="xs" fw={500}>
          Upwards
        </Text>
        <Checkbox
          size="xs"
          label="rate of change of the other axis"
          checked={up === null}
          onChange={(event) => set({ up: event.currentTarget.checked ? null : across })}
        />
        {up !== null && (
          <TraceControl trace={up} label="the vertical axis" set={(next) => set({ up: next })} />
        )}
      </div>
    </>
  );
}
