// The rows of a run: the distribution of one column in each combination of levels, and the table.

import { useMemo, useState } from "react";

import { AddButton } from "../widgets/AddButton";
import { ChoiceBox } from "../widgets/ChoiceBox";
import { useStudio } from "../server/store";
import { repeat } from "./actions";
import { Bars } from "./Bars";
import { cellText, type Column, columnsOf, type TrialRow } from "../model/trialRows";

// The rows that are shown first, and with each press on the button below them.
const MORE = 200;

export function Results() {
  const own = useStudio(({ trials, experiment }) =>
    experiment?.run?.number === trials.run ? trials.rows : NO_ROWS,
  );
  const columns = useMemo(() => columnsOf(own), [own]);
  const [chosen, setChosen] = useState("");
  const shown = columns.filter(({ sort }) => sort !== "level");
  const column = shown.find(({ name }) => name === chosen) ?? shown.at(-1);
  if (column === undefined) {
    return <p className="dim">The rows of the trials appear here while the experiment runs.</p>;
  }
  return (
    <>
      <div className="across">
        <ChoiceBox
          label="Shown column"
          value={column.name}
          choices={shown.map(({ name }) => name)}
          onCommit={(name) => setChosen(name ?? "")}
        />
      </div>
      <Bars rows={own} column={column} />
      <Table rows={own} columns={columns} />
    </>
  );
}

const NO_ROWS: TrialRow[] = [];

function Table({ rows, columns }: { rows: TrialRow[]; columns: Column[] }) {
  const [most, setMost] = useState(MORE);
  const [busy, setBusy] = useState<number | null>(null);
  const repeated = useStudio((state) => state.experiment?.repeated);
  const followed = useStudio((state) => state.experiment?.run?.state) === "followed";
  const sorted = useMemo(() => [...rows].sort((a, b) => a.trial - b.trial), [rows]);
  const replay = async (trial: number) => {
    if (busy === null && !followed) {
      setBusy(trial);
      await repeat(trial);
      setBusy(null);
    }
  };
  return (
    <div className="experiment-scroll">
      <table className="table experiment-rows">
        <caption>
          {followed
            ? "The trials can be run again when the experiment is complete."
            : "A click on a row runs its trial again, bit for bit, and opens its record."}
        </caption>
        <thead>
          <tr>
            <th scope="col">trial</th>
            {columns.map(({ name }) => (
              <th scope="col" key={name}>
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {sorted.slice(0, most).map((row) => (
            <tr
              key={row.trial}
              aria-selected={row.trial === repeated}
              data-busy={row.trial === busy || undefined}
              onClick={() => void replay(row.trial)}
            >
              <th scope="row">
                <button
                  type="button"
                  aria-label={`Replay trial ${row.trial}`}
                  disabled={busy !== null || followed}
                >
                  {row.trial}
                </button>
              </th>
              {columns.map(({ name, of }) => (
                <td key={name}>{cellText(of(row))}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
      {sorted.length > most && (
        <AddButton onClick={() => setMost(most + MORE)}>{sorted.length - most} more rows</AddButton>
      )}
    </div>
  );
}
