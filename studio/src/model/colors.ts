// Colours of plots. Every scale is monotone in lightness or has its turning point at 0, so that it reads
// without hues too.

import type { Shade } from "../draw/ink";
import type { ColorTable, ColorTables } from "../draw/paint";

export type ScaleName = "cividis" | "viridis" | "diverging" | "gray";

const ANCHORS: Record<ScaleName, string> = {
  cividis: "#00224e #123570 #3b496c #575d6d #707173 #8a8678 #a59c74 #c3b369 #e1cc55 #fee838",
  viridis: "#440154 #482878 #3e4989 #31688e #26828e #1f9e89 #35b779 #6ece58 #b5de2b #fde725",
  // Activation: below the threshold, white at it, above it. Lightness falls on both sides.
  diverging:
    "#08294b #0e4070 #21659f #4e93cb #93c1e6 #d3e6f5 #ffffff" +
    " #ffe3bd #ffb968 #f98328 #dd4d0d #a02f06 #641a02",
  gray: "#000000 #ffffff",
};

const anchorsOf = (name: ScaleName): number[][] => ANCHORS[name].split(" ").map(parts);

export const SCALES: { name: ScaleName; label: string }[] = [
  { name: "viridis", label: "Violet to yellow" },
  { name: "cividis", label: "Blue to yellow" },
  { name: "diverging", label: "Blue, white at the threshold, ember" },
  { name: "gray", label: "Black to white" },
];

const made = new Map<string, ColorTables>();

export function scale(name: ScaleName): ColorTables {
  return madeOnce(name, () => onBoth(interpolated(anchorsOf(name))));
}

// The same colours on a light and on a dark ground.
export function onBoth(table: ColorTable): ColorTables {
  return { light: table, dark: table };
}

function madeOnce(name: string, make: () => ColorTables): ColorTables {
  const tables = made.get(name) ?? make();
  made.set(name, tables);
  return tables;
}

// Okabe and Ito's colours, with the two that vanish on white or on black exchanged for their neighbours.
const CURVES = {
  light: ["#0b6cb3", "#d55e00", "#00795a", "#a3487f", "#96620a", "#2a8fc4", "#1a1a1a"],
  dark: ["#62b5f0", "#f0793a", "#35c795", "#e29ac4", "#e3ad3c", "#8fd0f5", "#f0e442"],
};

// The n-th colour of a set of curves.
export function curveColor(n: number, shade: Shade): string {
  const colors = CURVES[shade];
  return colors[n % colors.length] ?? "#808080";
}

// The colours of a field and of a level, in every box and plot. The light ones are those of
// `dd.figures.COLOR`, and theme.css has both: a test compares all three.
export const FIELD_COLORS = {
  light: {
    activation: "#0b6cb3",
    ember: "#c2410c",
    output: "#00795a",
    input: "#96620a",
    interaction: "#a3487f",
    level: "#555555",
  },
  dark: {
    activation: "#62b5f0",
    ember: "#ff8a4c",
    output: "#35c795",
    input: "#e3ad3c",
    interaction: "#e29ac4",
    level: "#a5a5b0",
  },
} as const;

// Ports of other names follow in order.
const FIRST_PORTS = ["activation", "output", "input", "interaction"] as const;
type FirstPort = (typeof FIRST_PORTS)[number];
const isFirst = (port: string): port is FirstPort => FIRST_PORTS.some((known) => known === port);

export function inOrder(ports: string[]): string[] {
  return [...FIRST_PORTS.filter((port) => ports.includes(port)), ...ports.filter((port) => !isFirst(port))];
}

export function portColor(port: string, ports: string[], shade: Shade): string {
  if (isFirst(port)) {
    return FIELD_COLORS[shade][port];
  }
  const others = ports.filter((other) => !isFirst(other));
  return curveColor(FIRST_PORTS.length + Math.max(0, others.indexOf(port)), shade);
}

// Whether the page is dark at present.
export function shade(): Shade {
  return document.documentElement.dataset["mantineColorScheme"] === "dark" ? "dark" : "light";
}

// The shorter reach of activation is at least the longer one divided by this.
const LEAST_REACH = 3;

// The colours of activation from `lower` to `upper`, as `dd.figures` has them: each side of the threshold has
// a reach of its own, over which it takes all of its colours. The colour nearest to the threshold is white.
export function activationScale(lower: number, upper: number, threshold: number): ColorTable {
  const below = Math.max(threshold - lower, (upper - threshold) / LEAST_REACH) || 1;
  const above = Math.max(upper - threshold, (threshold - lower) / LEAST_REACH) || 1;
  const nearest = Math.round((255 * (threshold - lower)) / (upper - lower));
  const places = Array.from({ length: 256 }, (_, i) => {
    const distance = i === nearest ? 0 : lower + (i / 255) * (upper - lower) - threshold;
    return 0.5 + (0.5 * distance) / (distance < 0 ? below : above);
  });
  return colored(anchorsOf("diverging"), places);
}

// The colour of nothing, in maps of amounts.
const SUNK = { light: "#ededef", dark: "#0d0d0f" };

// Amounts without a threshold have one hue, from the colour of nothing to that of the port's line.
export function amounts(port: string): ColorTables {
  const color = isFirst(port) ? port : "interaction";
  const table = (shade: Shade) => interpolated([SUNK[shade], FIELD_COLORS[shade][color]].map(parts));
  return madeOnce(`amounts of ${color}`, () => ({ light: table("light"), dark: table("dark") }));
}

function interpolated(anchors: number[][]): ColorTable {
  return colored(
    anchors,
    Array.from({ length: 256 }, (_, i) => i / 255),
  );
}

// The colours at 256 places from 0 to 1 between anchors at equal distances.
function colored(anchors: number[][], places: number[]): ColorTable {
  const table = new Uint8ClampedArray(4 * 256);
  for (const [i, wanted] of places.entries()) {
    const place = Math.min(1, Math.max(0, wanted)) * (anchors.length - 1);
    const left = Math.min(Math.floor(place), anchors.length - 2);
    const share = place - left;
    for (let c = 0; c < 3; c++) {
      table[4 * i + c] = (anchors[left]?.[c] ?? 0) * (1 - share) + (anchors[left + 1]?.[c] ?? 0) * share;
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

function parts(color: string): number[] {
  return [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
}
