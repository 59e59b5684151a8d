// Another time course for a plot over time.

import { Button, Text } from "@mantine/core";
import { useState } from "react";
import type { PlotSettings, TraceSetting } from "../settings";
import { TraceControl } from "./TraceControl";

type TraceAddingProps = {
  // The time course that is chosen first, which is the one of a plot without others.
  first: TraceSetting;
  traces: TraceSetting[];
  set: (settings: Partial<PlotSettings>) => void;
};

export function TraceAdding({ first, traces, set }: TraceAddingProps) {
  const [trace, setTrace] = useState(first);
  const shown = traces.length > 0 ? traces : [first];
  const there = shown.some((other) => JSON.stringify(other) === JSON.stringify(trace));
  const idle = there || trace.port === "";
  return (
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
        onClick={() => !idle && set({ traces: [...shown, trace] })}
      >
        {there ? "Already in this plot" : "Add"}
      </Button>
    </div>
  );
}
