// The panel of an experiment: its cards, its run, and its rows.

import "./experiment.css";

import { Button, Menu, Progress, SegmentedControl } from "@mantine/core";
import {
  IconArrowBackUp,
  IconFolderOpen,
  IconPlayerPlayFilled,
  IconPlayerStopFilled,
  IconPlus,
} from "@tabler/icons-react";
import { useEffect, useState } from "react";

import { HistoryButtons } from "../header/UndoButtons";
import { DotsMenu } from "../widgets/DotsMenu";
import { ProblemText } from "../problems/ProblemText";
import type { ExperimentView, RunView } from "../protocol";
import { useStudio } from "../store";
import { backToModel, close, create, open, redo, run, save, saveAs, stop, undo } from "./actions";
import { Design } from "./Design";
import { Results } from "./Results";

export function Experiment() {
  const experiment = useStudio((state) => state.experiment);
  const open_ = experiment !== null && experiment.data !== null;
  return (
    <section className="experiment inspector" aria-label="Experiment">
      {open_ ? <Opened experiment={experiment} /> : <Nothing />}
    </section>
  );
}

function Nothing() {
  return (
    <>
      <p className="dim">
        An experiment runs many trials of the model, detects events, changes parameters, and stores one row of
        measures for each trial.
      </p>
      <div className="experiment-head">
        <Button
          size="compact-sm"
          variant="default"
          leftSection={<IconPlus size={15} />}
          onClick={() => void create()}
        >
          New experiment
        </Button>
        <Button
          size="compact-sm"
          variant="default"
          leftSection={<IconFolderOpen size={15} />}
          onClick={() => void open()}
        >
          Open…
        </Button>
      </div>
    </>
  );
}

function Opened({ experiment }: { experiment: ExperimentView }) {
  const forms = useStudio((state) => state.welcome?.experiment);
  const [shown, setShown] = useState(experiment.run === null ? "design" : "results");
  const number = experiment.run?.number ?? 0;
  useEffect(() => setShown(number === 0 ? "design" : "results"), [number]);
  return (
    <>
      <Head experiment={experiment} />
      <SegmentedControl
        size="xs"
        fullWidth
        aria-label="Part of the experiment"
        data={[
          { value: "design", label: "Design" },
          { value: "results", label: "Results" },
        ]}
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
  return (
    <>
      <div className="experiment-head">
        {running ? (
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconPlayerStopFilled size={14} />}
            aria-label="Stop the experiment"
            onClick={() => void stop()}
          >
            Stop
          </Button>
        ) : (
          <Button
            size="compact-sm"
            leftSection={<IconPlayerPlayFilled size={14} />}
            aria-label={`${present?.state === "stopped" ? "Continue" : "Run"} the experiment`}
            disabled={problems.length > 0 || repeated !== null}
            onClick={() => void run()}
          >
            {present?.state === "stopped" ? "Continue" : "Run"}
          </Button>
        )}
        <Button
          size="compact-sm"
          variant="default"
          aria-label="Save the experiment"
          disabled={!unsaved && file !== ""}
          onClick={() => void save()}
        >
          Save
        </Button>
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
      {running && (
        <Progress
          size="xs"
          radius={0}
          value={(100 * present.rows) / Math.max(1, present.trials)}
          transitionDuration={0}
          aria-label="Trials that have ended"
        />
      )}
      {present?.problems.map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
      {repeated !== null && (
        <div className="experiment-head experiment-repeated">
          <span className="grow">Trial {repeated} is open as a record.</span>
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconArrowBackUp size={15} />}
            onClick={() => void backToModel()}
          >
            Back to the model
          </Button>
        </div>
      )}
    </>
  );
}

function statusText(present: RunView | null, trials: number, problems: number): string {
  if (present !== null) {
    const { rows, state, left } = present;
    const time = state === "running" && left !== null ? `, ${secondsText(left)} left` : "";
    const ended = state === "running" ? "" : state === "complete" ? ", complete" : `, ${state}`;
    return `${rows} of ${present.trials} trials${time}${ended}`;
  }
  return problems > 0 ? "cannot run yet" : `${trials} trials`;
}

function secondsText(seconds: number): string {
  return seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`;
}
