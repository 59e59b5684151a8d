// The slider over the moments that can be shown. It is always there, so that nothing moves when a run begins.

import { Button, NativeSelect, Slider, Tooltip } from "@mantine/core";
import {
  IconChevronLeft,
  IconChevronRight,
  IconPlayerPauseFilled,
  IconPlayerPlay,
  IconPlayerSkipBack,
  IconPlayerSkipForward,
} from "@tabler/icons-react";
import { type KeyboardEvent, useEffect, useRef } from "react";

import { type Studio, useStudio } from "../server/store";
import { countText, speedText, timeText } from "../model/format";
import { useThrottled } from "../state/throttled";
import { TipButton } from "../widgets/TipButton";
import { REPLAY_SPEEDS, thinnedShare } from "../state/playback";
import {
  replay,
  seek,
  seekFirst,
  seekFrames,
  seekLast,
  setReplaySpeed,
  showAgain,
  showPresent,
  stop,
  useReplay,
} from "../actions/replay";
import { SavedMenu } from "./SavedMenu";
import { RunFromButton } from "./RunFromButton";
import classes from "./Timeline.module.css";

const ICON = 15;
// The slider grows with every frame of a run; it need not be drawn with every frame.
const CALM_MS = 50;

const timelineOf = (state: Studio) => state.clock?.timeline ?? null;

export function Timeline() {
  const known = useThrottled(timelineOf, CALM_MS);
  const unit = useStudio((state) => state.document?.time_unit ?? "");
  const { playing, held } = useReplay();

  const open = useStudio((state) => state.connection === "open");
  const before = useRef<number | null>(null);
  useEffect(() => {
    if (open) {
      showAgain(before.current);
    } else {
      before.current = useStudio.getState().clock?.timeline?.time ?? null;
    }
  }, [open]);

  const off = known === null || known.frames < 2;
  const record = useStudio((state) => state.document?.record != null);
  const past = known?.time != null;
  const [first, last] = known === null || off ? [0, 1] : [known.first, known.last];
  const at = Math.min(last, Math.max(first, held ?? known?.time ?? last));
  const text = (time: number) => timeText(time, unit, known?.step ?? 1);
  const shown = held ?? known?.time ?? null;
  const thinned = known === null || off ? 0 : thinnedShare(known);

  const key = (event: KeyboardEvent) => {
    const action = KEYS[event.key];
    if (action !== undefined && !off && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      event.stopPropagation();
      action();
    }
  };
  const playButton = (direction: 1 | -1, tip: string) => {
    const isOn = playing?.direction === direction;
    const Icon = isOn ? IconPlayerPauseFilled : IconPlayerPlay;
    return (
      <TipButton tip={isOn ? "Stop replay" : tip} disabled={off} onClick={() => replay(direction)}>
        <Icon size={ICON} className={isOn || direction === 1 ? "" : classes.back} />
      </TipButton>
    );
  };
  return (
    <div
      className={`flow ${classes.timeline}`}
      role="toolbar"
      aria-label="Replay"
      data-past={(past && !record) || undefined}
    >
      <div className={`flow ${classes.buttons}`}>
        <TipButton tip="First frame (Home)" disabled={off} onClick={seekFirst} className={classes.wide}>
          <IconPlayerSkipBack size={ICON} />
        </TipButton>
        {playButton(-1, "Replay backward")}
        <TipButton tip="Previous frame (←)" disabled={off} onClick={() => seekFrames(-1)}>
          <IconChevronLeft size={ICON + 2} />
        </TipButton>
        <TipButton tip="Next frame (→)" disabled={off} onClick={() => seekFrames(1)}>
          <IconChevronRight size={ICON + 2} />
        </TipButton>
        {playButton(1, "Replay forward")}
        <TipButton tip="Last frame (End)" disabled={off} onClick={seekLast} className={classes.wide}>
          <IconPlayerSkipForward size={ICON} />
        </TipButton>
        <ReplaySpeed disabled={off} />
      </div>
      <div className={classes.slider} onKeyDownCapture={key}>
        {thinned > 0 && (
          <div
            className={classes.thinned}
            style={{ width: `${100 * thinned}%` }}
            title={`Before ${text(known?.full_from ?? 0)} some frames were removed to save memory`}
          />
        )}
        <Slider
          size={4}
          thumbSize={14}
          label={null}
          thumbLabel="Moment"
          thumbValueText={() => (shown === null ? "present" : text(shown))}
          min={first}
          max={last}
          step={(last - first) / 1e4}
          precision={9}
          value={at}
          disabled={off}
          onChange={(time) => {
            stop();
            useReplay.setState({ held: time });
            seek(time);
          }}
          onChangeEnd={() => useReplay.setState({ held: null })}
        />
      </div>
      <div className={`${classes.moment} numbers`} role="status" aria-label="Moment shown">
        <span className={classes.time}>{shown === null ? "" : text(shown)}</span>
        <span className={`${classes.count} dim`}>
          {off || known === null
            ? ""
            : past
              ? `frame ${countText(known.frame + 1)} of ${countText(known.frames)}`
              : ""}
        </span>
      </div>
      {!record && <SavedMenu />}
      <RunFromButton />
      {!record && (
        <Tooltip label="Back to the present">
          <Button
            size="compact-xs"
            w={50}
            px={0}
            variant={past ? "filled" : "default"}
            disabled={!past}
            aria-label="Live"
            onClick={showPresent}
          >
            Live
          </Button>
        </Tooltip>
      )}
    </div>
  );
}

const KEYS: Record<string, () => void> = {
  ArrowLeft: () => seekFrames(-1),
  ArrowDown: () => seekFrames(-1),
  ArrowRight: () => seekFrames(1),
  ArrowUp: () => seekFrames(1),
  PageDown: () => seekFrames(-10),
  PageUp: () => seekFrames(10),
  Home: seekFirst,
  End: seekLast,
};

const OPTIONS = REPLAY_SPEEDS.map((speed) => ({ value: String(speed), label: speedText(speed) }));

function ReplaySpeed({ disabled }: { disabled: boolean }) {
  const speed = useReplay((state) => state.speed);
  return (
    <NativeSelect
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
