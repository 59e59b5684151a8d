// An array along one axis: activation, output, input and interaction as curves, levels as lines.

import { points } from "../../draw/axis";
import { type Range, union } from "../../draw/scale";
import { isPicture, portsAlike } from "../../model/ports";
import { inOrder } from "../../model/colors";
import { curveLevel, firstCurves, LEVELS } from "../../model/shownPorts";
import type { LegendEntry, PlotDeclaration, Shown } from "./kind";
import { aboveThreshold, axesOf, extentOf, LEVEL, levelMarks, levelsAt, line, portPaint } from "./parts";

const MOST = 600;
const ROOM = 0.03;

export const plot: PlotDeclaration = {
  title: "Curves",
  rank: (axes) => (axes.length === 1 ? 0 : axes.length > 1 && !isPicture(axes) ? 20 : null),
  figure: 1,
  settings: () => ["drawn", "range", "push"],
  sides: ["Axis"],
  label: (shown) => {
    const { curves } = choice(shown);
    return `${curves.join(", ")} of ${shown.element.path} over ${axesOf(shown)[0]?.name ?? "its axis"}`;
  },
  file: ({ element }) => element.path,
  legend: (shown) => {
    const { ports, chosen, levels } = choice(shown);
    const entry = (label: string, more: Pick<LegendEntry, "color" | "dashed">): LegendEntry => ({
      label,
      ...more,
      on: chosen.includes(label),
      press: {
        shown: chosen.includes(label) ? chosen.filter((other) => other !== label) : [...chosen, label],
      },
    });
    return [
      ...ports.map((port) => entry(port, { color: portPaint(port, ports) })),
      ...(levels.length > 0 ? [entry(LEVELS, { color: LEVEL, dashed: true })] : []),
    ];
  },
  // a curve has one axis, also of an array with more
  wishes: (shown) =>
    choice(shown).curves.map((port) => ({
      type: "watch",
      element: shown.element.id,
      port,
      most: MOST,
      drawn: [shown.settings.drawn[0] ?? axesOf(shown)[0]?.name ?? ""],
      at: shown.settings.at,
    })),
  content: (shown, lives, memory) => {
    const { ports, curves, level, levels, chosen } = choice(shown);
    const form = lives.find((live) => live.form !== null)?.form;
    const x = form?.axes[0] ?? axesOf(shown)[0];
    if (x === undefined) {
      return null;
    }
    const xs = points(x, form?.shape[0]);
    const lines = curves.flatMap((port, i) => {
      const values = lives[i]?.frame?.values;
      const made = line(port, portPaint(port, ports), xs, values ?? []);
      const right = levels.length > 0 && port === "output" && port !== level && curves.length > 1;
      const look = { right, width: port === level ? 2 : 1.5, ...aboveThreshold(port, levels) };
      return values?.length === xs.length ? [{ ...made, ...look }] : [];
    });
    const shownLevels = chosen.includes(LEVELS) ? levels : [];
    const range = memory.around(extentOf(lines.filter(({ right }) => !right)), {
      include: shownLevels.map(({ value }) => value),
      fixed: shown.settings.range,
    });
    const outputs = lines.filter(({ right }) => right);
    return {
      x: { along: x, range: [x.lower, x.upper] },
      y: { along: null, range },
      ...(outputs.length === 0
        ? {}
        : { right: { along: null, label: "output", range: roomy(extentOf(outputs) ?? [0, 1]) } }),
      marks: [...lines, ...levelMarks(shownLevels)],
    };
  },
};

function choice(shown: Shown) {
  const { document, element, port, type, settings } = shown;
  const ports = inOrder(portsAlike(element, port));
  const level = curveLevel(element, type, port);
  const chosen = settings.shown ?? firstCurves(ports, level, document.record?.ports[element.id]);
  const curves = ports.filter((other) => chosen.includes(other));
  return { ports, level, levels: levelsAt(shown, level), chosen, curves };
}

// 0 to 1 with a little room for the line, unless values lie outside.
function roomy(extent: Range): Range {
  const [lower, upper] = union(extent, [0, 1]);
  const room = ROOM * (upper - lower);
  return [lower - room, upper + room];
}
