// The panel of regimes: what a field does alone, without noise, measured on request while the run continues.

import "./regime.css";

import { Button, NativeSelect, VisuallyHidden } from "@mantine/core";
import { IconPlayerStop, IconStopwatch } from "@tabler/icons-react";
import { useState } from "react";

import { ProblemText } from "../widgets/ProblemText";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { CurvePicture } from "./CurvePicture";
import { TuneSection } from "./TuneSection";

export function RegimePanel() {
  const regime = useStudio((state) => state.regime);
  const elements = useStudio((state) => state.elements);
  const selected = useStudio((state) => state.selected);
  const [asked, setAsked] = useState("");
  const fields = [...elements.values()].filter((element) => element.kind === "Field");
  const found = [asked, regime?.element, selected[0]].find((id) => fields.some((field) => field.id === id));
  const chosen = found ?? fields[0]?.id ?? "";
  if (fields.length === 0) {
    return <p className="regime dim">A document with a field or a node can be measured.</p>;
  }
  const measured = regime !== null && regime.element === chosen ? regime : null;
  const isMeasuring = measured?.measuring === true;
  const Icon = isMeasuring ? IconPlayerStop : IconStopwatch;
  const words = measured?.words ?? [];
  const field = elements.get(chosen);
  return (
    <div className="regime">
      <div className="flow regime-head">
        <NativeSelect
          aria-label="Field or node"
          value={chosen}
          onChange={(event) => setAsked(event.currentTarget.value)}
          data={fields.map((field) => ({ value: field.id, label: field.path }))}
        />
        <Button
          size="compact-sm"
          variant="default"
          leftSection={<Icon size={15} />}
          onClick={() =>
            void request(isMeasuring ? { type: "stop_regime" } : { type: "measure_regime", element: chosen })
          }
        >
          {isMeasuring ? "Stop" : words.length > 0 ? "Measure regime again" : "Measure regime"}
        </Button>
      </div>
      <div role="status">
        {isMeasuring && (
          <p className="dim">The field is measured in a process of its own, which takes some seconds.</p>
        )}
        {words.length > 0 && <p className="regime-words">{words.join("; ")}</p>}
        {words.length > 0 && measured?.stale === true && (
          <p className="regime-stale">The field has changed since: measure it again.</p>
        )}
      </div>
      {(measured?.problems ?? []).map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
      {measured?.curve != null && <CurvePicture curve={measured.curve} words={words.join("; ")} />}
      {words.length > 0 ? (
        <table className="regime-table">
          <VisuallyHidden component="caption">Measurements</VisuallyHidden>
          <tbody>
            {measured?.rows.map((row, i) => (
              <tr key={i}>
                <th scope="row">{row.name}</th>
                <td>{row.text}</td>
              </tr>
            ))}
          </tbody>
        </table>
      ) : (
        !isMeasuring && (
          <p className="dim">
            What the field does alone, without noise and without its inputs: at which strength of an input a
            peak appears and vanishes, whether it outlives its input, and whether one of two inputs wins. The
            run continues meanwhile.
          </p>
        )
      )}
      {field !== undefined && <TuneSection key={chosen} field={field} />}
    </div>
  );
}
