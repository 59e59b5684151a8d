// A phase plot: a time course against its rate of change, or against another time course. The newest sample,
// or the moment of the past that the page shows, is a dot; the tail behind it fades.

import { extent } from "../../draw/scale";
import { isPicture } from "../../model/ports";
import type { TraceSetting } from "../../model/settings";
import { traceLabel, traceOf } from "../../model/traces";
import type { PlotDeclaration, Shown } from "./kind";
import { axesOf, curvePaint, LEVEL, pathOf } from "./parts";
import { trajectory } from "./trajectory";

export const plot: PlotDeclaration = {
  title: "Phase plot",
  rank: (axes) => (isPicture(axes) ? null : 40),
  settings: () => ["window", "trajectory"],
  label: (shown) => {
    const [across, up] = names(shown);
    return `${up} over ${across} of ${shown.element.path}`;
  },
  file: ({ element }) => `${element.path} phase`,
  wishes: (shown) => traces(shown).map((trace) => ({ type: "trace", ...trace })),
  content: (shown, lives, memory) => {
    const { document, settings, moment } = shown;
    const [one, other] = lives;
    const times = one?.history.times ?? [];
    const newest = times[times.length - 1];
    if (one === undefined || newest === undefined || lives.length < traces(shown).length) {
      return null;
    }
    const end = moment ?? newest;
    const start = settings.window === null ? -Infinity : end - settings.window;
    const found = trajectory(one.history, settings.up === null ? null : (other?.history ?? null), [
      start,
      end,
    ]);
    const [across, up] = names(shown);
    const include = settings.up === null ? [0] : [];
    return {
      x: { along: null, label: across, range: memory.around(extent(found.across), { side: "x" }) },
      y: { along: null, label: up, range: memory.around(extent(found.up), { include }) },
      marks: [
        // fixed points lie where the rate is 0
        ...include.map((value) => ({ type: "level", label: "", value, color: LEVEL }) as const),
        {
          type: "tail",
          color: curvePaint(0),
          unit: document.time_unit,
          times: found.times,
          xs: found.across,
          ys: found.up,
        },
      ],
    };
  },
};

function traces(shown: Shown): TraceSetting[] {
  const { element, port, settings } = shown;
  const across = settings.across ?? traceOf(element.id, port, axesOf(shown), "max");
  return [across, ...(settings.up === null ? [] : [settings.up])];
}

function names(shown: Shown): [string, string] {
  const { time_unit: unit } = shown.document;
  const rate = `rate of change${unit === "" ? "" : ` (1/${unit})`}`;
  const [across = "", up = rate] = traces(shown).map((trace) =>
    traceLabel(trace, pathOf(shown, trace.element)),
  );
  return [across, up];
}
