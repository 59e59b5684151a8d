// Settings of a time course: its duration, its range, and additional curves.

import { Button, NumberInput, SegmentedControl, Select, Text } from "@mantine/core";
import { useState } from "react";
import type { AxisView } from "../protocol";
import { useStudio } from "../store";
import { mainPort, portAxes, portsOf } from "./kinds";
import type { Range } from "./paint";
import { RangeControl } from "./RangeControl";
import type { PlotSettings, TraceSetting } from "./settings";
import { WindowControl } from "./WindowControl";

type Controls = {
  element: string;
  traces: TraceSetting[];
  settings: PlotSettings;
  shown: () => Range;
  set: (settings: Partial<PlotSettings>) => void;
};

export function CourseControls({ element, traces, settings, shown, set }: Controls) {
  const document = useStudio((state) => state.document);
  const elements = useStudio((state) => state.elements);
  const kinds = useStudio((state) => state.kinds);
  const [chosen, setChosen] = useState(element);
  const [wantedPort, setPort] = useState("");
  const [reduce, setReduce] = useState<TraceSetting["reduce"]>("max");
  const [places, setPlaces] = useState<Record<string, number>>({});

  const found = elements.get(chosen);
  const ports = found === undefined ? [] : portsOf(found);
  const port = ports.includes(wantedPort)
    ? wantedPort
    : found === undefined
      ? ""
      : mainPort(found, kinds.get(found.kind));
  const axes = (document !== null && found !== undefined && portAxes(document, found, port)) || [];
  const place = (axis: AxisView) => places[axis.key] ?? (axis.lower + axis.upper) / 2;
  const trace: TraceSetting =
    axes.length === 0
      ? { element: chosen, port, reduce: "at", at: [] }
      : { element: chosen, port, reduce, at: reduce === "at" ? axes.map(place) : [] };
  const there = traces.some((other) => JSON.stringify(other) === JSON.stringify(trace));
  const idle = there || port === "";

  return (
    <>
      <WindowControl window={settings.window} set={(window) => set({ window })} />
      <RangeControl range={settings.range} shown={shown} set={(range) => set({ range })} />
      <div className="plot-more">
        <Text size="xs" fw={500}>
          Add a curve
        </Text>
        <Select
          size="xs"
          aria-label="Element of the new curve"
          searchable
          allowDeselect={false}
          comboboxProps={{ withinPortal: false }}
          data={[...elements.values()].map((other) => ({ value: other.id, label: other.path }))}
          value={chosen}
          onChange={(value) => value !== null && setChosen(value)}
        />
        <Select
          size="xs"
          aria-label="Port of the new curve"
          allowDeselect={false}
          comboboxProps={{ withinPortal: false }}
          data={ports}
          value={port}
          onChange={(value) => value !== null && setPort(value)}
        />
        {axes.length > 0 && (
          <SegmentedControl
            size="xs"
            fullWidth
            aria-label="Reduction of the array"
            data={[
              { value: "max", label: "maximum" },
              { value: "mean", label: "mean" },
              { value: "at", label: "at a place" },
            ]}
            value={reduce}
            onChange={(value) => setReduce(value as TraceSetting["reduce"])}
          />
        )}
        {axes.length > 0 && reduce === "at" && (
          <div className="plot-pair">
            {axes.map((axis) => (
              <NumberInput
                key={axis.key}
                size="xs"
                label={axis.unit === "" ? axis.name : `${axis.name} (${axis.unit})`}
                min={axis.lower}
                max={axis.upper}
                value={place(axis)}
                onChange={(value) => typeof value === "number" && setPlaces({ ...places, [axis.key]: value })}
              />
            ))}
          </div>
        )}
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
