// The values along an axis over time, as the page keeps them: the newest rows, in order of time.

import { extent, type Range } from "../draw/scale";
import type { Frame } from "./frames";

const MOST_ROWS = 16_384;

export class Rows {
  // Number of values of a row; 0 before the first one.
  width = 0;
  times: number[] = [];
  private rows: Float32Array[] = [];
  private extents: (Range | null)[] = [];

  // Rows of a frame: the time since the moment of the frame, followed by `width` values. A time before the
  // last one means that the run began again.
  add(frame: Frame, width: number): void {
    if (width !== this.width) {
      this.clear();
      this.width = width;
    }
    const size = width + 1;
    for (let i = 0; i + size <= frame.values.length; i += size) {
      const time = frame.time + (frame.values[i] ?? 0);
      const last = this.times[this.times.length - 1];
      if (last !== undefined && time < last) {
        this.forget();
      } else if (last === time) {
        continue;
      }
      this.times.push(time);
      const row = frame.values.subarray(i + 1, i + size);
      this.rows.push(row);
      this.extents.push(extent(row));
    }
    if (this.times.length > 2 * MOST_ROWS) {
      this.times = this.times.slice(-MOST_ROWS);
      this.rows = this.rows.slice(-MOST_ROWS);
      this.extents = this.extents.slice(-MOST_ROWS);
    }
  }

  clear(): void {
    this.width = 0;
    this.forget();
  }

  private forget(): void {
    this.times = [];
    this.rows = [];
    this.extents = [];
  }

  // The least and the greatest value of the rows within a range of time; null if there are none.
  extent([first, last]: Range): Range | null {
    let [lower, upper] = [Infinity, -Infinity];
    this.times.forEach((time, i) => {
      const row = time >= first && time <= last ? this.extents[i] : null;
      if (row != null) {
        [lower, upper] = [Math.min(lower, row[0]), Math.max(upper, row[1])];
      }
    });
    return lower <= upper ? [lower, upper] : null;
  }

  // The values at `count` moments, evenly spaced within a range of time: of the last row up to each moment,
  // NaN before the first row and after the last one. C order: index = moment * width + sample.
  spread([first, last]: Range, count: number): Float32Array {
    const out = new Float32Array(count * this.width).fill(Number.NaN);
    const step = (last - first) / count;
    const end = this.times[this.times.length - 1] ?? -Infinity;
    let row = -1;
    for (let i = 0; i < count; i++) {
      // The last moment of each column: the newest row shows as soon as it came.
      const time = first + (i + 1) * step;
      while ((this.times[row + 1] ?? Infinity) <= time) {
        row++;
      }
      const values = this.rows[row];
      if (values !== undefined && time - step <= end) {
        out.set(values, i * this.width);
      }
    }
    return out;
  }

  // The rows within a range of time.
  within([first, last]: Range): { times: number[]; values: number[] } {
    const times: number[] = [];
    const values: number[] = [];
    this.times.forEach((time, i) => {
      if (time >= first && time <= last) {
        times.push(time);
        values.push(...(this.rows[i] ?? []));
      }
    });
    return { times, values };
  }

  // The last row up to a moment; null if there is none.
  at(time: number): { time: number; values: Float32Array } | null {
    let low = 0;
    let high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.times[middle] as number) <= time) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    const [found, values] = [this.times[low - 1], this.rows[low - 1]];
    return found === undefined || values === undefined ? null : { time: found, values };
  }
}
