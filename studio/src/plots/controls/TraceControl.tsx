// The choice of a time course: an element, its port, and of an array the maximum, the mean or a position.

import { Button, SegmentedControl, Select, Text } from "@mantine/core";
import { useState } from "react";
import type { AxisView, ElementView } from "../../protocol";
import { useStudio } from "../../server/store";
import { axisLabel } from "../../draw/axis";
import { NumberField } from "../../widgets/NumberField";
import { mainPort, portAxes, portsOf } from "../../model/ports";
import type { TraceSetting } from "../../model/settings";
import { traceOf } from "../../model/traces";

const SELECT = { allowDeselect: false, comboboxProps: { withinPortal: false } } as const;

// `label` says what it is the choice of.
type TraceChoice = { trace: TraceSetting; label: string; set: (trace: TraceSetting) => void };

export function TraceControl({ trace, label, set }: TraceChoice) {
  const document = useStudio((state) => state.document);
  const elements = useStudio((state) => state.elements);
  const kinds = useStudio((state) => state.kinds);
  const { reduce } = trace;
  const found = elements.get(trace.element);
  const axesOf = (element: ElementView | undefined, port: string) =>
    (document !== null && element !== undefined && portAxes(document, element, port)) || [];
  const axes = axesOf(found, trace.port);
  const position = (axis: AxisView, i: number) => trace.at[i] ?? (axis.lower + axis.upper) / 2;
  const choose = (id: string, port?: string) => {
    const element = elements.get(id);
    const shown = port ?? (element === undefined ? "" : mainPort(element, kinds.get(element.kind)));
    set(traceOf(id, shown, axesOf(element, shown), reduce));
  };
  return (
    <>
      <Select
        {...SELECT}
        searchable
        aria-label={`Element of ${label}`}
        data={[...elements.values()].map((other) => ({ value: other.id, label: other.path }))}
        value={trace.element}
        onChange={(value) => value !== null && choose(value)}
      />
      <Select
        {...SELECT}
        aria-label={`Port of ${label}`}
        data={found === undefined ? [] : portsOf(found)}
        value={trace.port}
        onChange={(value) => value !== null && choose(trace.element, value)}
      />
      {axes.length > 0 && (
        <SegmentedControl
          fullWidth
          aria-label={`Reduction of ${label}`}
          data={[
            { value: "max", label: "maximum" },
            { value: "mean", label: "mean" },
            { value: "at", label: "at a place" },
          ]}
          value={reduce}
          onChange={(value) => set(traceOf(trace.element, trace.port, axes, value as TraceSetting["reduce"]))}
        />
      )}
      {axes.length > 0 && reduce === "at" && (
        <div className="plot-pair">
          {axes.map((axis, i) => (
            <NumberField
              key={axis.key}
              label={axisLabel(axis)}
              lower={axis.lower}
              upper={axis.upper}
              value={position(axis, i)}
              set={(value) =>
                set({ ...trace, at: axes.map((other, j) => (i === j ? value : position(other, j))) })
              }
            />
          ))}
        </div>
      )}
    </>
  );
}

type TraceAddingProps = {
  // The time course that is chosen first, which is the one of a plot without others.
  first: TraceSetting;
  traces: TraceSetting[];
  set: (settings: { traces: TraceSetting[] }) => void;
};

// Another time course for a plot over time.
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
