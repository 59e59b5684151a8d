// The controls of the run: play, step, reset, speed, and where it is.

import {
  IconPlayerPauseFilled,
  IconPlayerPlayFilled,
  IconPlayerSkipBackFilled,
  IconPlayerTrackNextFilled,
} from "@tabler/icons-react";

import { RecordBar } from "../replay/RecordBar";
import { useStudio } from "../server/store";
import { TipButton } from "../widgets/TipButton";
import { Busy } from "./Busy";
import { Readout } from "./Readout";
import { RecordButton } from "./RecordButton";
import { RunMenu } from "./RunMenu";
import { SpeedMenu } from "./SpeedMenu";
import { WorldButton } from "./WorldButton";
import { countText } from "../model/format";
import { play, reset, step, useNext } from "../actions/run";
import classes from "./Transport.module.css";

export function Transport() {
  const record = useStudio((state) => state.document?.record ?? null);
  return record === null ? <RunTransport /> : <RecordBar record={record} />;
}

function RunTransport() {
  // in the past, Play returns to the present and continues
  const running = useStudio(
    (state) => (state.clock?.running ?? false) && (state.clock?.timeline?.time ?? null) === null,
  );
  const steps = useNext((state) => state.steps);
  const seed = useNext((state) => state.seed);
  const stepLabel = steps === 1 ? "Step" : `${countText(steps)} steps`;
  const withSeed = seed === null ? "" : `, with seed ${seed}`;
  const resetTip = `Reset: state, time and noise back to the start${withSeed}. Parameters stay. (Shift+R)`;
  return (
    <div className={`flow ${classes.transport}`} role="toolbar" aria-label="Run">
      <div className={`flow ${classes.buttons}`}>
        <TipButton tip={resetTip} aria-label="Reset" size={28} onClick={() => void reset()}>
          <IconPlayerSkipBackFilled size={16} />
        </TipButton>
        <TipButton
          tip={running ? "Pause (Space)" : "Play (Space)"}
          variant="filled"
          color="deodar"
          size={32}
          onClick={() => void play()}
        >
          {running ? <IconPlayerPauseFilled size={18} /> : <IconPlayerPlayFilled size={18} />}
        </TipButton>
        <TipButton tip={`${stepLabel} (.)`} size={28} onClick={() => void step()}>
          <IconPlayerTrackNextFilled size={16} />
        </TipButton>
        <RecordButton />
      </div>
      <Readout />
      <div className={`flow ${classes.buttons}`}>
        <SpeedMenu />
        <RunMenu />
        <WorldButton />
      </div>
      <Busy />
    </div>
  );
}
