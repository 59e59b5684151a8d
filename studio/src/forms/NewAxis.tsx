// A new axis in one row: name, from, to, samples, unit, periodic. Enter or the button makes it.

import { Checkbox, TextInput } from "@mantine/core";
import { useState } from "react";

import { type AxisProperties, newAxis } from "../model/elementAxes";
import type { AxisView, ListedProblem } from "../protocol";
import { refusalOf } from "../server/socket";
import { useLateFocus } from "../widgets/lateFocus";
import { typedNumber } from "../model/number";
import { SmallForm } from "./SmallForm";

type NewAxisProps = {
  // The axes of the document: the new one has another name at first.
  axes: readonly AxisView[];
  // Makes it; false, or the reason: it was refused.
  onMake: (axis: AxisProperties) => Promise<boolean | ListedProblem>;
  onDone: () => void;
};

const WORDS = ["name", "from", "to", "samples", "unit"] as const;

export function NewAxis({ axes, onMake, onDone }: NewAxisProps) {
  const field = useLateFocus();
  const [begun] = useState(() => newAxis(axes));
  const [typed, setTyped] = useState({
    name: begun.name,
    from: String(begun.lower),
    to: String(begun.upper),
    samples: String(begun.samples),
    unit: "",
  });
  const [periodic, setPeriodic] = useState(false);
  const send = async () => {
    const [lower, upper, samples] = [typed.from, typed.to, typed.samples].map(typedNumber);
    return lower == null || upper == null || samples == null
      ? { what: "From, to and samples need numbers." }
      : onMake({ name: typed.name.trim(), lower, upper, samples, unit: typed.unit.trim(), periodic });
  };
  return (
    <SmallForm
      className="new-axis"
      label="New axis"
      submit="Make"
      ready={typed.name.trim() !== ""}
      send={send}
      onDone={onDone}
    >
      {() => (
        <>
          {WORDS.map((word) => (
            <label key={word}>
              <span>{word}</span>
              <TextInput
                aria-label={`${word} of the new axis`}
                inputMode={word === "name" || word === "unit" ? "text" : "decimal"}
                ref={word === "name" ? field : undefined}
                value={typed[word]}
                onFocus={(event) => event.currentTarget.select()}
                onChange={(event) => setTyped({ ...typed, [word]: event.currentTarget.value })}
              />
            </label>
          ))}
          <label>
            <span>periodic</span>
            <Checkbox
              aria-label="periodic new axis"
              checked={periodic}
              onChange={(event) => setPeriodic(event.currentTarget.checked)}
            />
          </label>
        </>
      )}
    </SmallForm>
  );
}

// Add an axis to the document, which no element has yet.
export async function addAxis(axis: AxisProperties): Promise<true | ListedProblem> {
  return (await refusalOf({ type: "add_axis", axis })) ?? true;
}
