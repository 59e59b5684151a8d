// How fast a replay plays.

import { NativeSelect } from "@mantine/core";

import { speedText } from "../transport/format";
import { REPLAY_SPEEDS } from "./playback";
import { setReplaySpeed, useReplay } from "./replay";
import classes from "./Timeline.module.css";

const OPTIONS = REPLAY_SPEEDS.map((speed) => ({ value: String(speed), label: speedText(speed) }));

export function ReplaySpeed({ disabled }: { disabled: boolean }) {
  const speed = useReplay((state) => state.speed);
  return (
    <NativeSelect
      size="xs"
      variant="unstyled"
      className={classes.speed}
      aria-label="Speed of the replay"
      title="Speed of the replay: time of the model in relation to real time"
      data={OPTIONS}
      value={String(speed)}
      disabled={disabled}
      onChange={(event) => setReplaySpeed(Number(event.currentTarget.value))}
    />
  );
}
