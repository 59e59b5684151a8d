// Small multiples: the same port of all elements over the same axes, side by side on the same scales.

import { points } from "../../draw/axis";
import type { Content, MapColors } from "../../draw/content";
import { extent } from "../../draw/scale";
import { elementsAlike, isPicture } from "../../model/ports";
import type { ElementView } from "../../protocol";
import type { Live } from "../../server/streams";
import { scaleOf } from "../../model/mapColors";
import type { Memory } from "./memory";
import type { PlotDeclaration, ControlName, Shown } from "./kind";
import {
  aboveThreshold,
  axesOf,
  courseLines,
  endsOf,
  extentOf,
  levelsAt,
  line,
  planeContent,
  portPaint,
  spanOf,
  timeSide,
} from "./parts";

const MOST_CELLS = 48;
const MOST_POINTS = 300;
const MOST_CELL_SAMPLES = 64;

const CONTROLS: readonly (readonly ControlName[])[] = [["window", "range"], ["range"]];

export const plot: PlotDeclaration = {
  title: "Small multiples",
  rank: (axes, { several }) => (several && !isPicture(axes) ? 90 : null),
  settings: (shown) => CONTROLS[axesOf(shown).length] ?? ["drawn", "scale", "range"],
  sides: ["To the right", "Upwards"],
  ports: (axes) => !isPicture(axes),
  label: ({ element, port }) => `${port} of elements like ${element.path}`,
  file: (shown) => `${shown.port} of ${cells(shown).length} elements`,
  cells,
  wishes: (shown) => {
    const { port, settings } = shown;
    const { drawn, at } = settings;
    const axes = axesOf(shown).length;
    const most = axes === 1 ? MOST_POINTS : MOST_CELL_SAMPLES;
    return cells(shown).map(({ id }) =>
      axes === 0
        ? { type: "trace", element: id, port, reduce: "at", at: [] }
        : { type: "watch", element: id, port, most, drawn, at },
    );
  },
  contents: (shown, lives, memory) =>
    [courses, curves][axesOf(shown).length]?.(shown, lives, memory) ?? maps(shown, lives, memory),
};

function cells({ document, element, port }: Shown): readonly ElementView[] {
  return elementsAlike(document, element, port).slice(0, MOST_CELLS);
}

function courses(shown: Shown, lives: readonly Live[], memory: Memory): Content[] {
  const { port, settings } = shown;
  const span = spanOf(shown, endsOf(lives.map(({ history }) => history.times)));
  const lines = courseLines(lives, span, () => [port, portPaint(port, [port])]);
  const range = memory.around(extentOf(lines), { fixed: settings.range });
  const x = { ...timeSide(shown, span), down: false };
  const above = aboveThreshold(port, levelsAt(shown, port));
  return lines.map((mark) => ({ x, y: { along: null, range }, marks: [{ ...mark, ...above }] }));
}

function curves(shown: Shown, lives: readonly Live[], memory: Memory): (Content | null)[] {
  const { port, settings } = shown;
  const lines = lives.map(({ form, frame }) => {
    const x = form?.axes[0];
    const values = frame?.values;
    return x === undefined || values === undefined
      ? null
      : { x, mark: line(port, portPaint(port, [port]), points(x, values.length), values) };
  });
  const all = extentOf(lines.flatMap((one) => one?.mark ?? []));
  const range = memory.around(all, { fixed: settings.range });
  const above = aboveThreshold(port, levelsAt(shown, port));
  return lines.map((one) =>
    one === null
      ? null
      : {
          x: { along: one.x, range: [one.x.lower, one.x.upper] },
          y: { along: null, range },
          marks: [{ ...one.mark, ...above }],
        },
  );
}

// The values of all cells on one scale of colours.
function maps(shown: Shown, lives: readonly Live[], memory: Memory): (Content | null)[] {
  const { port, type, settings } = shown;
  const ends = lives.flatMap(({ frame }): number[] => [...(extent(frame?.values ?? []) ?? [])]);
  const how = scaleOf(settings.scale, type, port);
  const colors: MapColors = memory.colors(ends, how, levelsAt(shown, port), settings.range);
  return lives.map((live) => planeContent(shown.document, live, port, () => colors));
}
