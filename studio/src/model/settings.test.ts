import { expect, it } from "vitest";
import { readSettings } from "./settings";

it("invalid settings are replaced by the defaults", () => {
  const usual = readSettings({});
  expect(usual).toEqual({
    shown: null,
    range: null,
    scale: "auto",
    traces: [],
    window: 2000,
    across: null,
    up: null,
    down: false,
    drawn: [],
    at: {},
    view: null,
    amplitude: null,
    width: 0.05,
  });
  const strange = {
    shown: [1],
    range: [2, 1],
    scale: "rainbow",
    traces: [{ element: "a" }, 1],
    window: 3,
    across: { element: "a" },
    up: "rate",
    drawn: "x",
    at: { x: "left", y: null },
    view: { azimuth: 30 },
    amplitude: "5",
    width: "wide",
  };
  expect(readSettings(strange)).toEqual(usual);
  expect(readSettings({ range: [0, null], traces: "all" })).toEqual(usual);
});

it("valid settings are kept", () => {
  const trace = { element: "a", port: "output", reduce: "at", at: [1.5] };
  const good = {
    shown: ["output"],
    range: [-1, 2],
    scale: "gray",
    across: trace,
    up: { ...trace, reduce: "max", at: [] },
    down: true,
    drawn: ["z", "x"],
    at: { y: -1.5 },
    view: { azimuth: 30, elevation: -10, zoom: 2 },
    traces: [trace],
    window: null,
    amplitude: -3,
    width: 0.1,
  };
  expect(readSettings(good)).toEqual(good);
});
