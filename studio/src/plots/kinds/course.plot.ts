// Values over time: of nodes, and of arrays their maximum, mean, or value at a place. Several in one plot.

import type { CurveLine } from "../../draw/content";
import type { TraceSetting } from "../../model/settings";
import { timeWindows } from "../../model/timeWindows";
import { traceLabel, traceOf } from "../../model/traces";
import type { PlotDeclaration, Shown } from "./kind";
import {
  aboveThreshold,
  axesOf,
  courseLines,
  curvePaint,
  endsOf,
  extentOf,
  levelsAt,
  momentMarks,
  pathOf,
  spanOf,
  timeSide,
} from "./parts";

export const plot: PlotDeclaration = {
  title: "Time course",
  rank: () => 10,
  figure: Number.POSITIVE_INFINITY,
  settings: () => ["window", "range", "traces"],
  label: (shown) => `${labels(shown).join(", ")} over time`,
  file: ({ element }) => `${element.path} over time`,
  legend: (shown) => {
    const [traces, names] = [tracesOf(shown), labels(shown)];
    return names.map((label, i) => ({
      label,
      color: curvePaint(i),
      on: true,
      ...(names.length > 1 ? { remove: { traces: traces.filter((_, other) => other !== i) } } : {}),
    }));
  },
  wishes: (shown) => tracesOf(shown).map((trace) => ({ type: "trace", ...trace })),
  content: (shown, lives, memory) => {
    const names = labels(shown);
    const span = spanOf(shown, endsOf(lives.map(({ history }) => history.times)));
    const courses = courseLines(lives, span, (i) => [names[i] ?? "", curvePaint(i)]);
    const lines = courses.map((course) => ({ ...course, ...above(shown) }));
    return {
      x: { ...timeSide(shown, span), down: false },
      y: { along: null, range: memory.around(extentOf(lines), { fixed: shown.settings.range }) },
      marks: [{ type: "windows", spans: timeWindows(shown.element.values) }, ...lines, ...momentMarks(shown)],
    };
  },
};

function tracesOf(shown: Shown): TraceSetting[] {
  const { element, port, settings } = shown;
  return settings.traces.length > 0 ? settings.traces : [traceOf(element.id, port, axesOf(shown), "max")];
}

// Of several courses each has one colour, by which it is known; a mean says nothing about the threshold.
function above(shown: Shown): Pick<CurveLine, "above"> {
  const [trace, ...others] = tracesOf(shown);
  return trace?.element === shown.element.id && trace.reduce !== "mean" && others.length === 0
    ? aboveThreshold(trace.port, levelsAt(shown, trace.port))
    : {};
}

function labels(shown: Shown): string[] {
  return tracesOf(shown).map((trace) => traceLabel(trace, pathOf(shown, trace.element)));
}
