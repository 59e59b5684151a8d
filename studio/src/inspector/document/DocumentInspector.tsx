// The document as a whole: title, notes, step, axes, and its own parameters.

import { Textarea } from "@mantine/core";
import { useState } from "react";

import type { Describe, ListedProblem } from "../../protocol";
import { refusalOf, socket } from "../../server/socket";
import { useStudio } from "../../server/store";
import { AddButton } from "../../widgets/AddButton";
import { addAxis, NewAxis } from "../../forms/NewAxis";
import { AxisLines } from "../../forms/AxesForm";
import { ChoiceBox } from "../../widgets/ChoiceBox";
import { TextBox } from "../../widgets/TextBox";
import { DocumentParameters } from "./DocumentParameters";
import { NumberField } from "../../widgets/NumberField";
import { numberText } from "../../model/number";
import { ProblemBanner } from "../../problems/ProblemBanner";
import { ProblemLine } from "../../widgets/ProblemLine";
import { timeText } from "../../model/unit";
import { PlainRow } from "../../forms/PlainRow";

const TIME_UNITS = ["us", "ms", "s", "min", "abstract"];

export function DocumentInspector() {
  const document = useStudio((state) => state.document);
  const dt = useStudio((state) => state.clock?.dt);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const [adding, setAdding] = useState(false);
  const [notes, setNotes] = useState<string | null>(null);
  if (document === null) {
    return null;
  }
  const unit = timeText(document.time_unit);
  const describe = async (what: Omit<Describe, "type">): Promise<boolean> => {
    const refusal = await refusalOf({ type: "describe", ...what });
    setProblem(refusal);
    return refusal === null;
  };
  const keepNotes = () => {
    if (notes !== null && notes !== document.notes) {
      void describe({ notes });
    }
    setNotes(null);
  };
  return (
    <>
      <header className="inspector-header">
        <h2 className="one-line" title={document.title}>
          {document.title || "Untitled"}
        </h2>
        <span className="kind-title">Document</span>
      </header>
      <ProblemBanner element="" />
      <section className="parameters" aria-label="Document">
        <PlainRow name="title">
          <TextBox label="Title" value={document.title} onCommit={(name) => describe({ name })} />
        </PlainRow>
        <PlainRow name="step dt">
          <NumberField
            label="Step dt"
            labelled={false}
            value={document.dt}
            unit={unit}
            placeholder={dt === undefined ? "" : `${numberText(dt)} (default)`}
            set={(value) => socket.ask({ type: "describe", dt: value })}
          />
        </PlainRow>
        <PlainRow name="time unit">
          <ChoiceBox
            label="Time unit"
            value={document.time_unit}
            choices={[...new Set([...TIME_UNITS, document.time_unit])]}
            onCommit={(time_unit) => void describe({ time_unit })}
          />
        </PlainRow>
        <ProblemLine problem={problem} />
        <Textarea
          label="notes"
          autosize
          minRows={2}
          maxRows={14}
          value={notes ?? document.notes}
          onChange={(event) => setNotes(event.currentTarget.value)}
          onKeyDown={(event) => event.key === "Escape" && setNotes(null)}
          onBlur={keepNotes}
        />
      </section>
      <DocumentParameters parameters={document.parameters} />
      <section className="parameters" aria-label="Axes">
        <h3>
          Axes
          <AddButton aria-label="Add an axis" onClick={() => setAdding(true)} />
        </h3>
        {adding && <NewAxis axes={document.axes} onMake={addAxis} onDone={() => setAdding(false)} />}
        <AxisLines axes={document.axes} />
      </section>
      <p className="dim hint">Select an element to see its parameters.</p>
    </>
  );
}
