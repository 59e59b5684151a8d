// Simulated time and the ratio to real time, always visible: numbers that count without moving.

import { Tooltip } from "@mantine/core";

import { useOffline } from "../widgets/NeedsServer";
import { type Studio, useStudio } from "../server/store";
import { compilingText, countText, factorText, timeText, unitText } from "../model/format";
import { lateText, meterLines } from "./meter";
import { useThrottled } from "../state/throttled";
import classes from "./Readout.module.css";

const clockOf = (state: Studio) => state.clock;

export function Readout() {
  const clock = useThrottled(clockOf);
  const unit = useStudio((state) => state.document?.time_unit ?? "");
  const running = useStudio((state) => state.clock?.running ?? false);
  const record = useStudio((state) => state.document?.record != null);
  const past = clock?.timeline?.time ?? null;
  const offline = useOffline();
  const time =
    clock === null
      ? "–"
      : timeText(past ?? clock.time, unit, record ? (clock.timeline?.step ?? 1) : clock.dt);
  const tick =
    clock === null
      ? ""
      : offline
        ? "not connected"
        : past !== null
          ? record
            ? "in the record"
            : "in the past"
          : `step ${countText(clock.tick)}`;
  const factor = clock === null || !running || offline ? "×–" : factorText(clock.factor);
  const dt =
    clock === null
      ? ""
      : `Simulated time, in steps of ${Number(clock.dt.toPrecision(6))} ${unitText(unit)}`.trimEnd();
  const pace =
    unit === "abstract"
      ? "Simulated time over real time, 1 unit taken as 1 ms"
      : "Simulated time over real time, measured";
  // Where the header is narrow the compilation takes the place of the speed, which a run without a program
  // does not have.
  const compiling = clock?.compiling ?? null;
  const late = clock === null ? "" : lateText(clock);
  return (
    <div className={`flow ${classes.readout} numbers`} data-offline={offline || undefined}>
      <Tooltip label={dt}>
        <div className={classes.time} role="timer" aria-label="Simulated time">
          <div className={classes.number}>{time}</div>
          <div className={`${classes.under} fine`} data-past={(past !== null && !record) || undefined}>
            {tick}
          </div>
        </div>
      </Tooltip>
      {compiling !== null && (
        <div className={classes.compiling} data-running={running || undefined} aria-hidden="true">
          <div>{compiling.phase}</div>
          <div className={`${classes.under} fine`}>{compilingText(compiling)}</div>
        </div>
      )}
      <Tooltip label={<Lines lines={clock === null ? [pace] : meterLines(pace, clock, unit)} />}>
        <div
          className={classes.factor}
          data-compiling={(compiling !== null && !running) || undefined}
          data-still={!running || offline || undefined}
          role="group"
          aria-label="Speed measured"
        >
          <div className={classes.number}>{factor}</div>
          <div className={`${classes.under} fine`} data-late={(!offline && late !== "") || undefined}>
            {(!offline && late) || "real time"}
          </div>
        </div>
      </Tooltip>
    </div>
  );
}

function Lines({ lines }: { lines: string[] }) {
  return (
    <>
      {lines.map((line) => (
        <div key={line}>{line}</div>
      ))}
    </>
  );
}
