// What a plot panel keeps with the document: which element, how it is shown, and settings of its kind. They
// are read with care, because a document may hold anything.

import { SCALES, type ScaleName } from "./colors";
import type { PlotKind } from "./ports";
import type { Range } from "../draw/scale";
import type { Viewpoint } from "./sceneView";

export type TraceSetting = { element: string; port: string; reduce: "at" | "max" | "mean"; at: number[] };

export type PlotSettings = {
  // Curves that are shown; null: the first choice.
  shown: string[] | null;
  // Values on the axis or the colour scale; null: follow the data.
  range: Range | null;
  scale: ScaleName | "auto";
  // Time courses beside the first one.
  traces: TraceSetting[];
  // The newest time that is shown, in time units; null: all.
  window: number | null;
  // The time courses of a phase plot: to the right (null: the plot's own), and upwards (null: the rate of
  // change of the other one).
  across: TraceSetting | null;
  up: TraceSetting | null;
  // Whether time runs downwards, not to the right.
  down: boolean;
  // The names of the axes that are drawn (none: the first ones), and positions on others.
  drawn: string[];
  at: Record<string, number>;
  // The view of a scene in three dimensions; null: the first one.
  view: Viewpoint | null;
  // What a right-click injects: null is a first guess; the width (sigma) is a share of the axis.
  amplitude: number | null;
  width: number;
};

export type PlotParams = {
  element: string;
  kind: PlotKind | null;
  port: string;
  settings: Partial<PlotSettings>;
};

export const WINDOWS = [500, 2000, 10_000, null];

export function readSettings(given: Record<string, unknown>): PlotSettings {
  return {
    shown: isTexts(given["shown"]) ? given["shown"] : null,
    range: readRange(given["range"]),
    scale: SCALES.find((scale) => scale.name === given["scale"])?.name ?? "auto",
    traces: Array.isArray(given["traces"]) ? given["traces"].filter(isTrace) : [],
    window: WINDOWS.includes(given["window"] as number | null) ? (given["window"] as number | null) : 2000,
    across: isTrace(given["across"]) ? given["across"] : null,
    up: isTrace(given["up"]) ? given["up"] : null,
    down: given["down"] === true,
    drawn: isTexts(given["drawn"]) ? given["drawn"] : [],
    at: isRecord(given["at"])
      ? Object.fromEntries(
          Object.entries(given["at"]).filter((pair): pair is [string, number] => finite(pair[1]) !== null),
        )
      : {},
    view: readView(given["view"]),
    amplitude: finite(given["amplitude"]),
    width: Math.min(1, Math.max(0.001, finite(given["width"]) ?? 0.05)),
  };
}

function readRange(given: unknown): Range | null {
  if (!Array.isArray(given)) {
    return null;
  }
  const [lower, upper] = given.map(finite);
  return lower != null && upper != null && lower < upper ? [lower, upper] : null;
}

function readView(given: unknown): Viewpoint | null {
  const { azimuth, elevation, zoom } = isRecord(given) ? given : {};
  const numbers = [azimuth, elevation, zoom].map(finite);
  return numbers.includes(null) ? null : ({ azimuth, elevation, zoom } as Viewpoint);
}

function isTrace(given: unknown): given is TraceSetting {
  return (
    isRecord(given) &&
    typeof given["element"] === "string" &&
    typeof given["port"] === "string" &&
    ["at", "max", "mean"].includes(given["reduce"] as string) &&
    Array.isArray(given["at"]) &&
    given["at"].every((place) => finite(place) !== null)
  );
}

function isTexts(given: unknown): given is string[] {
  return Array.isArray(given) && given.every((item) => typeof item === "string");
}

function isRecord(given: unknown): given is Record<string, unknown> {
  return typeof given === "object" && given !== null && !Array.isArray(given);
}

function finite(given: unknown): number | null {
  return typeof given === "number" && Number.isFinite(given) ? given : null;
}
