// A new axis in one row: name, from, to, samples, unit, periodic. Enter or the button makes it.

import { Button, Checkbox, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";

import { type AxisProperties, newAxis } from "../../model/elementAxes";
import type { AxisView, ListedProblem } from "../../protocol";
import { socket } from "../../socket";
import { useLateFocus } from "../../widgets/lateFocus";
import { ProblemLine } from "../../widgets/ProblemLine";
import { typedNumber } from "../../widgets/number";

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
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const make = async (event: FormEvent) => {
    event.preventDefault();
    const [lower, upper, samples] = [typed.from, typed.to, typed.samples].map(typedNumber);
    if (lower == null || upper == null || samples == null) {
      setProblem({ what: "From, to and samples need numbers." });
      return;
    }
    const axis = { name: typed.name.trim(), lower, upper, samples, unit: typed.unit.trim(), periodic };
    const made = await onMake(axis);
    if (made === true) {
      onDone();
    } else if (made !== false) {
      setProblem(made);
    }
  };
  return (
    <form
      className="new-axis"
      aria-label="New axis"
      onSubmit={(event) => void make(event)}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      {WORDS.map((word) => (
        <label key={word}>
          <span>{word}</span>
          <TextInput
            size="xs"
            aria-label={`${word} of the new axis`}
            inputMode={word === "name" || word === "unit" ? "text" : "decimal"}
            autoComplete="off"
            spellCheck={false}
            ref={word === "name" ? field : undefined}
            value={typed[word]}
            onFocus={(event) => event.currentTarget.select()}
            onChange={(event) => {
              setTyped({ ...typed, [word]: event.currentTarget.value });
              setProblem(null);
            }}
          />
        </label>
      ))}
      <label>
        <span>periodic</span>
        <Checkbox
          size="xs"
          aria-label="periodic new axis"
          checked={periodic}
          onChange={(event) => setPeriodic(event.currentTarget.checked)}
        />
      </label>
      <Button size="compact-xs" type="submit" disabled={typed.name.trim() === ""}>
        Make
      </Button>
      <Button size="compact-xs" variant="subtle" color="gray" onClick={onDone}>
        Cancel
      </Button>
      <ProblemLine problem={problem} />
    </form>
  );
}

// Add an axis to the document, which no element has yet.
export async function addAxis(axis: AxisProperties): Promise<true | ListedProblem> {
  const { answer } = await socket.ask({ type: "add_axis", axis });
  return answer.problems?.[0] ?? true;
}
