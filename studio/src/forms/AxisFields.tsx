// The properties of one of the document's axes. A change acts on every element that has the axis.

import { Button, Switch } from "@mantine/core";
import { useState } from "react";

import type { AxisProperties } from "../model/elementAxes";
import type { AxisView, ListedProblem } from "../protocol";
import { refusalOf } from "../server/socket";
import { useStudio } from "../server/store";
import { ProblemLine } from "../widgets/ProblemLine";
import { TextBox } from "../widgets/TextBox";
import { NumberBox } from "../widgets/NumberBox";

export function AxisFields({ axis }: { axis: AxisView }) {
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const users = useStudio(
    (state) =>
      state.document?.elements.filter(({ axes }) =>
        Object.values(axes).some((keys) => keys.includes(axis.key)),
      ).length ?? 0,
  );
  const change = async (next: Partial<AxisProperties>): Promise<boolean> => {
    const { key, ...properties } = axis;
    const refusal = await refusalOf({ type: "change_axis", key, axis: { ...properties, ...next } });
    setProblem(refusal);
    return refusal === null;
  };
  const remove = async () => setProblem(await refusalOf({ type: "remove_axis", key: axis.key }));
  const number = (name: "lower" | "upper" | "samples", label: string, unit = "") => (
    <label className="axis-field">
      <span>{label}</span>
      <NumberBox
        label={`${label} of the axis ${axis.name}`}
        value={axis[name]}
        unit={unit}
        rejected={problem !== null}
        onCommit={(value) => (value === null ? Promise.resolve(false) : change({ [name]: value }))}
        onForget={() => setProblem(null)}
        onComplain={setProblem}
      />
    </label>
  );
  const text = (name: "name" | "unit", label: string) => (
    <label className="axis-field">
      <span>{label}</span>
      <TextBox
        label={`${label} of the axis ${axis.name}`}
        value={axis[name]}
        onCommit={(value) => change({ [name]: value })}
      />
    </label>
  );
  return (
    <section className="axis-fields" aria-label={`Axis ${axis.name}`}>
      <b className="one-line">Axis {axis.name}</b>
      {text("name", "Name")}
      {number("lower", "From", axis.unit)}
      {number("upper", "To", axis.unit)}
      {number("samples", "Samples")}
      {text("unit", "Unit")}
      <Switch
        label="Periodic"
        checked={axis.periodic}
        onChange={(event) => void change({ periodic: event.currentTarget.checked })}
      />
      <p className="dim">
        {["No element has", "One element has"][users] ?? `${users} elements have`} this axis.
      </p>
      <Button size="compact-xs" variant="default" onClick={() => void remove()}>
        {["Remove", "Remove, also from the element"][users] ?? "Remove, also from elements"}
      </Button>
      <ProblemLine problem={problem} />
    </section>
  );
}
