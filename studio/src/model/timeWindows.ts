// The time windows in which a stimulus is on, over time.

import { type Values, valueAt } from "./values";

export function timeWindows(values: Values): [number, number][] {
  const windows = values["windows"];
  return (Array.isArray(windows) ? windows : []).flatMap((window: unknown) => {
    const [start, stop] = [valueAt(window, "start"), valueAt(window, "stop")];
    return typeof start === "number" && typeof stop === "number" ? [[start, stop]] : [];
  });
}
