// Settings of a time course: its duration, its range, and additional curves.

import { Button, Text } from "@mantine/core";
import { useState } from "react";
import type { Range } from "../colors/paint";
import { RangeControl } from "./RangeControl";
import type { PlotSettings, TraceSetting } from "../settings";
import { TraceControl } from "./TraceControl";
import { WindowControl } from "./WindowControl";

type Controls = {
  // The time course that is chosen first.
  first: TraceSetting;
  traces: TraceSetting[];
  settings: PlotSettings;
  shown: () => Range;
  set: (settings: Partial<PlotSettings>) => void;
};

export function CourseControls({ first, traces, settings, shown, set }: Controls) {
  const [trace, setTrace] = useState(first);
  const there = traces.some((other) => JSON.stringify(other) === JSON.stringify(trace));
  const idle = there || trace.port === "";
  return (
    <>
      <WindowControl window={settings.window} set={(window) => set({ window })} />
      <RangeControl range={settings.range} shown={shown} set={(range) => set({ range })} />
      <div className="plot-more">
        <Text size="xs" fw={500}>
          Add a curve
        </Text>
        <TraceControl trace={trace} label="the new curve" set={setTrace} />
        {/* The focus stays here when nothing can be added, so that Escape still closes the settings. */}
        <Button
          size="compact-xs"
          variant="light"
          data-disabled={idle || undefined}
          aria-disabled={idle}
          onClick={() => !idle && set({ traces: [...traces, trace] })}
        >
          {there ? "Already in this plot" : "Add"}
        </Button>
      </div>
    </>
  );
}
