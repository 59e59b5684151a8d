// The controls of a plot, those that its kind names.

import { Checkbox, NativeSelect, SegmentedControl, Switch, Text } from "@mantine/core";
import type { ReactNode } from "react";
import type { Range } from "../../draw/scale";
import type { Announced, AxisView } from "../../protocol";
import { useStudio } from "../../server/store";
import { NumberField } from "../../widgets/NumberField";
import { SCALES, type ScaleName } from "../../model/colors";
import type { ControlName, Shown } from "../kinds/kind";
import { axesOf } from "../kinds/parts";
import { allAxes, exchanged } from "../../model/section";
import { type PlotSettings, WINDOWS } from "../../model/settings";
import { traceOf } from "../../model/traces";
import { TraceAdding, TraceControl } from "./TraceControl";

type SetSettings = (settings: Partial<PlotSettings>) => void;

type ControlsProps = {
  names: readonly ControlName[];
  // What the axes are called that can be exchanged.
  sides: readonly string[];
  shown: Shown;
  form: Announced | null;
  // The range that is shown now.
  range: () => Range;
  amplitude: number;
  set: SetSettings;
};

export function PlotSettingsControls({ names, sides, shown, form, range, amplitude, set }: ControlsProps) {
  const { element, settings } = shown;
  const unit = useStudio((state) => state.document?.time_unit);
  const has = (name: ControlName) => names.includes(name);
  return (
    <>
      {has("drawn") && <AxisControl axes={allAxes(form)} labels={sides} set={set} />}
      {has("window") && (
        <div>
          <Text size="xs" fw={500} mb={2}>
            Newest {unit ?? "time units"} shown
          </Text>
          <SegmentedControl
            fullWidth
            aria-label="Displayed duration"
            data={WINDOWS.map((length) => ({ value: String(length), label: String(length ?? "all") }))}
            value={String(settings.window)}
            onChange={(value) => set({ window: value === "null" ? null : Number(value) })}
          />
        </div>
      )}
      {has("down") && (
        <SegmentedControl
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
      {has("scale") && <ColorControl settings={settings} set={set} />}
      {has("range") && <RangeControl settings={settings} shown={range} set={set} />}
      {has("push") && element.pushable && (
        <>
          <div className="plot-pair">
            <NumberField
              label="Injected amplitude"
              value={amplitude}
              set={(value) => set({ amplitude: value })}
            />
            <NumberField
              label="Width (% of axis)"
              value={100 * settings.width}
              lower={0.1}
              upper={100}
              set={(value) => set({ width: value / 100 })}
            />
          </div>
          <Text size="xs" c="dimmed">
            Hold the right button or a finger on the plot, or the key I, to inject a Gaussian; with Shift the
            same everywhere.
          </Text>
        </>
      )}
      {has("traces") && <TraceAdding first={ownTrace(shown)} traces={settings.traces} set={set} />}
      {has("trajectory") && <TrajectoryControls shown={shown} set={set} />}
    </>
  );
}

type AxisChoice = {
  // All axes of the array, the drawn ones first.
  axes: AxisView[];
  // What each drawn axis is called, in their order.
  labels: readonly string[];
  set: SetSettings;
};

// The choice of the axes that are drawn.
export function AxisControl({ axes, labels, set }: AxisChoice) {
  if (axes.length < 2) {
    return null;
  }
  const names = axes.map(({ name }) => name);
  const drawn = names.slice(0, labels.length);
  return (
    <div className="plot-pair">
      {labels.map((label, place) => (
        <NativeSelect
          key={label}
          label={label}
          data={[...names].sort()}
          value={drawn[place]}
          onChange={(event) => set({ drawn: exchanged(drawn, place, event.currentTarget.value) })}
        />
      ))}
    </div>
  );
}

export function ColorControl({ settings, set }: { settings: PlotSettings; set: SetSettings }) {
  return (
    <NativeSelect
      label="Colours"
      data={[
        { value: "auto", label: "Fitting the port" },
        ...SCALES.map(({ name, label }) => ({ value: name, label })),
      ]}
      value={settings.scale}
      onChange={(event) => set({ scale: event.currentTarget.value as ScaleName | "auto" })}
    />
  );
}

type RangeChoice = { settings: PlotSettings; shown: () => Range; set: SetSettings };

// The range of values of a plot: it follows the data or is fixed.
export function RangeControl({ settings: { range }, shown, set }: RangeChoice) {
  const change = (lower: number, upper: number) => lower < upper && set({ range: [lower, upper] });
  return (
    <>
      <Switch
        label="Range follows the values"
        checked={range === null}
        onChange={(event) => set({ range: event.currentTarget.checked ? null : shown() })}
      />
      {range !== null && (
        <div className="plot-pair">
          <NumberField
            label="Lowest value"
            value={range[0]}
            upper={range[1]}
            set={(value) => void change(value, range[1])}
          />
          <NumberField
            label="Highest value"
            value={range[1]}
            lower={range[0]}
            set={(value) => void change(range[0], value)}
          />
        </div>
      )}
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
      <More title="To the right">
        <TraceControl trace={across} label="the horizontal axis" set={(next) => set({ across: next })} />
      </More>
      <More title="Upwards">
        <Checkbox
          label="rate of change of the other axis"
          checked={up === null}
          onChange={(event) => set({ up: event.currentTarget.checked ? null : across })}
        />
        {up !== null && (
          <TraceControl trace={up} label="the vertical axis" set={(next) => set({ up: next })} />
        )}
      </More>
    </>
  );
}

function More({ title, children }: { title: string; children: ReactNode }) {
  return (
    <div className="plot-more">
      <Text size="xs" fw={500}>
        {title}
      </Text>
      {children}
    </div>
  );
}
