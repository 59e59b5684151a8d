// The moment that the page shows: asking for another one, a frame at a time, and playing.

import type { TimelineView } from "../protocol";
import { request, socket } from "../server/socket";
import { pageStore } from "../state/pageStore";
import { useStudio } from "../server/store";
import { type Playing, played } from "../state/playback";

type Replay = {
  // How the page plays; null: it does not.
  playing: Playing | null;
  speed: number;
  // Where the user holds the slider; null: the slider shows the moment.
  held: number | null;
  // The trial and the point of a sweep that the page shows: the index along each dimension; 0 where none is.
  copy: Record<string, number>;
};

export const useReplay = pageStore<Replay>(() => ({ playing: null, speed: 1, held: null, copy: {} }));

const timeline = (): TimelineView | null => useStudio.getState().clock?.timeline ?? null;

// Whether the page shows a moment of the past, or of a record.
export const isPast = (): boolean => timeline()?.time != null;

// Whether the open document is that of a record.
export const isRecord = (): boolean => useStudio.getState().document?.record != null;

// Show another moment, null: the present. A run is paused, as a video is.
export function seek(time: number | null): void {
  if (time !== null) {
    pauseRun();
  }
  socket.post({ type: "seek", time });
}

export function seekFrames(frames: number): void {
  stop();
  pauseRun();
  socket.post({ type: "seek_frames", frames });
}

export const seekFirst = (): void => seekEnd((known) => known.first);
export const seekLast = (): void => seekEnd((known) => known.last);

export function showPresent(): void {
  stop();
  seek(null);
}

// Let the run continue from the moment shown. The server computes its state again.
export async function runFrom(): Promise<void> {
  const time = timeline()?.time;
  if (time != null) {
    stop();
    await request({ type: isRecord() ? "run_record_from" : "run_from", time });
  }
}

export function stop(): void {
  useReplay.setState({ playing: null });
}

// Play from the present moment on; at the end in that direction, from the other end on.
export function replay(direction: 1 | -1): void {
  const known = timeline();
  if (known === null) {
    return;
  }
  const before = useReplay.getState().playing;
  if (before?.direction === direction) {
    stop();
    return;
  }
  const [from, to] = direction === 1 ? [known.first, known.last] : [known.last, known.first];
  const at = known.time ?? known.last;
  let head = at === to ? from : at;
  seek(head);
  useReplay.setState({ playing: { direction, speed: useReplay.getState().speed } });
  if (before === null) {
    let last = performance.now();
    const next = (now: number) => {
      const [how, here] = [useReplay.getState().playing, timeline()];
      if (how === null || here === null) {
        stop();
        return;
      }
      const { time, ended } = played(head, now - last, how, here);
      [head, last] = [time, now];
      seek(head);
      if (ended) {
        stop();
      } else {
        requestAnimationFrame(next);
      }
    };
    requestAnimationFrame(next);
  }
}

export function setReplaySpeed(speed: number): void {
  const { playing } = useReplay.getState();
  useReplay.setState({ speed, playing: playing === null ? null : { ...playing, speed } });
}

export function chooseCopy(dimension: string, index: number): void {
  useReplay.setState(({ copy }) => ({ copy: { ...copy, [dimension]: index } }));
  socket.post({ type: "choose_copy", dimension, index });
}

// After a new connection, whose page the server does not know yet.
export function showAgain(time: number | null): void {
  for (const [dimension, index] of Object.entries(useReplay.getState().copy)) {
    socket.post({ type: "choose_copy", dimension, index });
  }
  if (time !== null) {
    socket.post({ type: "seek", time });
  }
}

function seekEnd(end: (known: TimelineView) => number): void {
  const known = timeline();
  if (known !== null) {
    stop();
    seek(end(known));
  }
}

function pauseRun(): void {
  if (useStudio.getState().clock?.running === true && !isPast()) {
    socket.post({ type: "pause" });
  }
}
