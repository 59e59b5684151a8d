// Document parameters: numbers with a name that drive parameters of elements.

import { useState } from "react";

import type { KnobView } from "../protocol";
import { AddButton } from "./AddButton";
import { KnobAdding } from "./KnobAdding";
import { KnobItem } from "./KnobItem";

export function KnobList({ knobs }: { knobs: KnobView[] }) {
  const [adding, setAdding] = useState(false);
  return (
    <section className="parameters" aria-label="Document parameters">
      <h3>
        Document parameters
        <AddButton aria-label="Add a document parameter" onClick={() => setAdding(true)} />
      </h3>
      {adding && <KnobAdding onDone={() => setAdding(false)} />}
      {knobs.map((knob) => (
        <KnobItem key={knob.name} knob={knob} />
      ))}
      {knobs.length === 0 && !adding && (
        <p className="dim hint">
          None. One document parameter can drive parameters of several elements together.
        </p>
      )}
    </section>
  );
}
