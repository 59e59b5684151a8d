import { expect, test } from "vitest";

import type { RunView } from "../protocol";
import { isStated, type RunPlace, placeText, requestOf, secondsText, standingLines } from "./runPlace";

const PLACE: RunPlace = {
  on: "machine",
  workers: null,
  address: " tls://host:8786 ",
  patience: 600,
  trust: true,
  mixed: false,
};
const RUN: RunView = {
  number: 1,
  folder: "a-001",
  state: "running",
  rows: 4,
  trials: 8,
  left: 3,
  problems: [],
  stopping: false,
  cluster: "",
  workers: 0,
  pieces: 0,
  slowest: "",
  diverged: [],
};

test("a request names either processes or a cluster", () => {
  expect(requestOf(PLACE)).toEqual({ workers: 0 });
  expect(requestOf({ ...PLACE, workers: 3 })).toEqual({ workers: 3 });
  expect(requestOf({ ...PLACE, on: "cluster" })).toEqual({
    cluster: "tls://host:8786",
    patience: 600,
    trust_network: true,
    mixed: false,
  });
});

test("a cluster without an address cannot run", () => {
  expect(isStated(PLACE)).toBe(true);
  expect(isStated({ ...PLACE, on: "cluster" })).toBe(true);
  expect(isStated({ ...PLACE, on: "cluster", address: " " })).toBe(false);
});

test("the place is said in a few words", () => {
  expect(placeText(PLACE, 1)).toBe("1 process");
  expect(placeText({ ...PLACE, workers: 3 }, 1)).toBe("3 processes");
  expect(placeText({ ...PLACE, on: "cluster" }, 1)).toBe("tls://host:8786");
  expect(placeText({ ...PLACE, on: "cluster", address: "" }, 1)).toBe("a cluster");
});

test("a run says its workers, its slowest and its diverging combinations", () => {
  expect(standingLines(RUN)).toEqual(["Processes start"]);
  expect(standingLines({ ...RUN, cluster: "local:2" })).toEqual(["Waiting for the workers of local:2"]);
  const busy = { ...RUN, workers: 1, pieces: 1, slowest: "gain 2, median 50", diverged: ["gain 3, 1 of 2"] };
  const cells = ["Slowest: gain 2, median 50", "Diverged: gain 3, 1 of 2"];
  expect(standingLines(busy)).toEqual(["1 worker, 1 piece in flight", ...cells]);
  expect(standingLines({ ...busy, workers: 2, pieces: 4, cluster: "local:2" })[0]).toBe(
    "2 workers of local:2, 4 pieces in flight",
  );
  expect(standingLines({ ...busy, stopping: true })[0]).toBe("Stopping");
  expect(standingLines({ ...busy, state: "followed" })).toEqual([
    "Another process runs this experiment. Its rows are read every second.",
    ...cells,
  ]);
  expect(standingLines({ ...busy, state: "complete" })).toEqual([]);
});

test("a time is said in seconds, minutes or hours", () => {
  expect([0.2, 89, 90, 5399, 7260].map(secondsText)).toEqual([
    "1 s",
    "89 s",
    "2 min",
    "1 h 30 min",
    "2 h 1 min",
  ]);
});
