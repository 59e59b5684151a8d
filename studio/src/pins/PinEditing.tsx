// The range of a pinned slider, or its label, to change.

import { Button, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";

import { useLateFocus } from "../widgets/lateFocus";
import { numberText, typedNumber } from "../model/number";
import { ProblemLine } from "../widgets/ProblemLine";
import type { SliderRange } from "../model/sliderRange";
import type { PinView } from "../protocol";
import { changedPin } from "../state/pin";
import { keepPins } from "../actions/pinning";

type PinEditingProps = { what: "range" | "label"; pin: PinView; range: SliderRange; onDone: () => void };

export function PinEditing({ what, pin, range, onDone }: PinEditingProps) {
  const field = useLateFocus();
  const [lower, setLower] = useState(numberText(range.lower));
  const [upper, setUpper] = useState(numberText(range.upper));
  const [label, setLabel] = useState(pin.label ?? "");
  const [wrong, setWrong] = useState("");

  const onSubmit = (event: FormEvent) => {
    event.preventDefault();
    const [low, high] = [typedNumber(lower), typedNumber(upper)];
    if (what === "label") {
      keepPins((pins) => changedPin(pins, pin, { label: label.trim() || undefined }));
    } else if (low === null || high === null || low >= high) {
      setWrong("A range needs two numbers, the smaller one first");
      return;
    } else {
      keepPins((pins) => changedPin(pins, pin, { lower: low, upper: high }));
    }
    onDone();
  };
  return (
    <form
      className="pin-editing"
      onSubmit={onSubmit}
      onKeyDown={(event) => event.key === "Escape" && onDone()}
    >
      {what === "label" ? (
        <TextInput
          size="xs"
          aria-label="Label"
          placeholder={pin.parameter}
          ref={field}
          value={label}
          onChange={(event) => setLabel(event.currentTarget.value)}
        />
      ) : (
        <>
          <TextInput
            size="xs"
            aria-label="Lower end"
            ref={field}
            value={lower}
            error={wrong !== ""}
            onFocus={(event) => event.currentTarget.select()}
            onChange={(event) => setLower(event.currentTarget.value)}
          />
          <span className="dim">to</span>
          <TextInput
            size="xs"
            aria-label="Upper end"
            value={upper}
            error={wrong !== ""}
            onFocus={(event) => event.currentTarget.select()}
            onChange={(event) => setUpper(event.currentTarget.value)}
          />
        </>
      )}
      <Button size="compact-xs" type="submit">
        Set
      </Button>
      <Button size="compact-xs" variant="subtle" color="gray" onClick={onDone}>
        Cancel
      </Button>
      <ProblemLine problem={wrong === "" ? null : { what: wrong }} />
    </form>
  );
}
