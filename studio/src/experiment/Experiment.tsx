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
import type { ExperimentView, ListedProblem, RunView } from "../protocol";
import { useStudio } from "../store";
import { backToModel, close, create, open, redo, run, save, saveAs, stop, undo } from "./actions";
import { Design } from "./Design";
import { isStated, secondsText, standingLines, useRunPlace } from "./runPlace";
import { Results } from "./Results";
import { Where } from "./Where";

export function Experiment() {
  const experiment = useStudio((state) => state.experiment);
  const open_ = experiment !== null && experiment.data !== null;
  return (
    <div className="experiment inspector">{open_ ? <Opened experiment={experiment} /> : <Nothing />}</div>
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
  const followed = present?.state === "followed";
  const place = useRunPlace();
  // What is wrong with the place of a run that did not begin.
  const [refused, setRefused] = useState<ListedProblem[]>([]);
  useEffect(() => setRefused([]), [place, present?.state]);
  return (
    <>
      <div className="experiment-head">
        {running ? (
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconPlayerStopFilled size={14} />}
            aria-label="Stop the experiment"
            disabled={present.stopping}
            onClick={() => void stop()}
          >
            Stop
          </Button>
        ) : (
          <Button
            size="compact-sm"
            leftSection={<IconPlayerPlayFilled size={14} />}
            aria-label={`${present?.state === "stopped" ? "Continue" : "Run"} the experiment`}
            disabled={problems.length > 0 || repeated !== null || (followed && !unsaved) || !isStated(place)}
            onClick={() => void run().then(setRefused)}
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
      {[...(present?.problems ?? []), ...refused].map((problem, i) => (
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

function Standing({ run: present }: { run: RunView }) {
  const lines = standingLines(present);
  return (
    lines.length > 0 && (
      <ul className="experiment-standing dim numbers" aria-label="Standing of the experiment">
        {lines.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    )
  );
}

function statusText(present: RunView | null, trials: number, problems: number): string {
  if (present !== null) {
    const { rows, state, left } = present;
    if (state !== "running" && state !== "followed") {
      return `${rows} of ${present.trials} trials, ${state}`;
    }
    const share = `${Math.floor((100 * rows) / Math.max(1, present.trials))} %`;
    const time = left === null ? "" : `, ${secondsText(left)} left`;
    return `${rows} of ${present.trials} trials (${share})${time}`;
  }
  return problems > 0 ? "cannot run yet" : `${trials} trials`;
}
