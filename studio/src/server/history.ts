// A time course as the page keeps it: the newest samples, in order of time.

import type { Frame } from "./frames";

const MOST_SAMPLES = 20_000;

export class History {
  times: number[] = [];
  values: number[] = [];

  // Pairs (time since the moment of the frame, value). A time before the last one means that the run began
  // again.
  add(frame: Frame): void {
    for (let i = 0; i + 1 < frame.values.length; i += 2) {
      const time = frame.time + (frame.values[i] ?? 0);
      const last = this.times[this.times.length - 1];
      if (last !== undefined && time < last) {
        this.clear();
      } else if (last === time) {
        continue;
      }
      this.times.push(time);
      this.values.push(frame.values[i + 1] ?? 0);
    }
    if (this.times.length > 2 * MOST_SAMPLES) {
      this.times = this.times.slice(-MOST_SAMPLES);
      this.values = this.values.slice(-MOST_SAMPLES);
    }
  }

  clear(): void {
    this.times = [];
    this.values = [];
  }
}
