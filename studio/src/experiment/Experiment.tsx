// The panel of an experiment: its cards, its run, and its rows.

import "./experiment.css";

import { Menu, Progress } from "@mantine/core";
import {
  IconArrowBackUp,
  IconFolderOpen,
  IconPlayerPlayFilled,
  IconPlayerStopFilled,
  IconPlus,
} from "@tabler/icons-react";
import { useEffect, useState } from "react";

import { HistoryButtons } from "../widgets/UndoButtons";
import { PanelButton } from "../widgets/Buttons";
import { Segments } from "../widgets/Segments";
import { DotsMenu } from "../widgets/DotsMenu";
import { ProblemTexts } from "../widgets/ProblemText";
import type { ExperimentView, ListedProblem, RunView } from "../protocol";
import { useStudio } from "../server/store";
import { backToModel, close, create, open, redo, run, save, saveAs, stop, undo } from "./actions";
import { Design } from "./Design";
import { isStated, secondsText, standingLines, useRunPlace } from "./runPlace";
import { Results } from "./Results";
import { Where } from "./Where";

export function Experiment() {
  const experiment = useStudio((state) => state.experiment);
  const open_ = experiment !== null && experiment.data !== null;
  return (
    <div className="experiment inspector down">
      {open_ ? <Opened experiment={experiment} /> : <Nothing />}
    </div>
  );
}

function Nothing() {
  return (
    <>
      <p className="dim">
        An experiment runs many trials of the model, detects events, changes parameters, and stores one row of
        measures for each trial.
      </p>
      <div className="across experiment-head">
        <PanelButton label="New experiment" icon={IconPlus} onClick={() => void create()} />
        <PanelButton label="Open…" icon={IconFolderOpen} onClick={() => void open()} />
      </div>
    </>
  );
}

function Opened({ experiment }: { experiment: ExperimentView }) {
  const forms = useStudio((state) => state.welcome?.experiment);
  const number = experiment.run?.number ?? 0;
  const [shown, setShown] = useState<"design" | "results">(number === 0 ? "design" : "results");
  useEffect(() => setShown(number === 0 ? "design" : "results"), [number]);
  return (
    <>
      <Head experiment={experiment} />
      <Segments
        fullWidth
        label="Part of the experiment"
        options={{ design: "Design", results: "Results" }}
        value={shown}
        onChange={setShown}
      />
      {shown === "results" ? <Results /> : forms !== undefined && <Design forms={forms} />}
    </>
  );
}

function Head({ experiment }: { experiment: ExperimentView }) {
  const { run: present, file, unsaved, trials, repeated, problems } = experiment;
  const running = present?.state === "running";
  const followed = present?.state === "followed";
  const place = useRunPlace();
  // What is wrong with the place of a run that did not begin.
  const [refused, setRefused] = useState<ListedProblem[]>([]);
  useEffect(() => setRefused([]), [place, present?.state]);
  return (
    <>
      <div className="across experiment-head">
        {running ? (
          <PanelButton
            label="Stop"
            icon={IconPlayerStopFilled}
            aria-label="Stop the experiment"
            disabled={present.stopping}
            onClick={() => void stop()}
          />
        ) : (
          <PanelButton
            variant="filled"
            icon={IconPlayerPlayFilled}
            label={present?.state === "stopped" ? "Continue" : "Run"}
            aria-label={`${present?.state === "stopped" ? "Continue" : "Run"} the experiment`}
            disabled={problems.length > 0 || repeated !== null || (followed && !unsaved) || !isStated(place)}
            onClick={() => void run().then(setRefused)}
          />
        )}
        <PanelButton
          label="Save"
          aria-label="Save the experiment"
          disabled={!unsaved && file !== ""}
          onClick={() => void save()}
        />
        <HistoryButtons
          undo={experiment.undo}
          redo={experiment.redo}
          of=" in the experiment"
          onUndo={() => void undo()}
          onRedo={() => void redo()}
        />
        <span className="experiment-status grow one-line dim" role="status" title={file}>
          {statusText(present, trials, problems.length)}
        </span>
        <DotsMenu label="More for the experiment">
          <Menu.Item onClick={() => void saveAs()}>Save as…</Menu.Item>
          <Menu.Item onClick={() => void open()}>Open…</Menu.Item>
          <Menu.Item onClick={() => void create()}>New</Menu.Item>
          <Menu.Item onClick={() => void close()}>Close</Menu.Item>
        </DotsMenu>
      </div>
      {(running || followed) && (
        <Progress
          size="xs"
          radius={0}
          value={(100 * present.rows) / Math.max(1, present.trials)}
          transitionDuration={0}
          aria-label="Trials that have ended"
        />
      )}
      {present !== null && <Standing run={present} />}
      {!running && !(followed && !unsaved) && <Where />}
      <ProblemTexts problems={[...(present?.problems ?? []), ...refused]} />
      {repeated !== null && (
        <div className="across experiment-head experiment-repeated">
          <span className="grow">Trial {repeated} is open as a record.</span>
          <PanelButton label="Back to the model" icon={IconArrowBackUp} onClick={() => void backToModel()} />
        </div>
      )}
    </>
  );
}

function Standing({ run: present }: { run: RunView }) {
  const lines = standingLines(present);
  return (
    lines.length > 0 && (
      <ul className="wrapped dim" aria-label="Standing of the experiment">
        {lines.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    )
  );
}

function statusText(present: RunView | null, trials: number, problems: number): string {
  if (present === null) {
    return problems > 0 ? "cannot run yet" : `${trials} trials`;
  }
  const { rows, state, left, trials: all } = present;
  if (state !== "running" && state !== "followed") {
    return `${rows} of ${all} trials, ${state}`;
  }
  const time = left === null ? "" : `, ${secondsText(left)} left`;
  return `${rows} of ${all} trials (${Math.floor((100 * rows) / Math.max(1, all))} %)${time}`;
}
