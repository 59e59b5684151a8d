// What the kinds of plots make of streams: contents, what lies at a cursor, and tables.

import { describe, expect, it } from "vitest";
import type { At } from "../../draw/cursorText";
import { readContent } from "../../draw/cursorText";
import { csv, tableOf } from "../../draw/table";
import { History } from "../../server/history";
import type { AxisView, DocumentView, ElementView, Kind } from "../../protocol";
import { Rows } from "../../server/rows";
import type { Live } from "../../server/streams";
import { Memory } from "./memory";
import { type PlotSettings, readSettings } from "../../model/settings";
import type { FlatPlot, Shown } from "./kind";
import { PLOTS } from "./plots";

const axis = (name: string, samples: number): AxisView => ({
  key: name,
  name,
  lower: 0,
  upper: samples - 1,
  samples,
  periodic: false,
  unit: "cm",
});
const [X, Y, CHANNEL] = [axis("x", 3), axis("y", 2), axis("channel", 3)];

const TYPE = {
  levels: { activation: { threshold: "theta", rest: "rest" } },
  maps: { weights: ["output", "input"] },
} as unknown as Kind;

const element = (id: string, axes: string[]): ElementView =>
  ({
    id,
    path: id,
    kind: "k",
    values: { theta: 0, rest: -5, windows: [{ start: 20, stop: 80 }] },
    inputs: ["input"],
    outputs: ["activation", "output"],
    axes: { activation: axes, output: axes, input: axes },
    pushable: true,
  }) as unknown as ElementView;

type More = { settings?: Partial<PlotSettings>; moment?: number; others?: ElementView[]; port?: string };

function shown(
  axes: string[],
  { settings = {}, moment, others = [], port = "activation" }: More = {},
): Shown {
  const plotted = element("u", axes);
  const elements = [plotted, ...others];
  return {
    document: { axes: [X, Y, CHANNEL], elements, parameters: [], time_unit: "ms" } as unknown as DocumentView,
    elements: new Map(elements.map((one) => [one.id, one])),
    type: TYPE,
    element: plotted,
    port,
    settings: { ...readSettings({}), ...settings },
    moment: moment ?? null,
  };
}

function live(axes: AxisView[], values: number[], shape = axes.map(({ samples }) => samples)): Live {
  const form = { axes: axes.slice(0, 2), shape, rest: [], folded: [], channels: axes.length === 3 };
  const frame = { stream: 1, frame: 1, time: 0, values: Float32Array.from(values) };
  return { form, frame, history: new History(), rows: new Rows(), lost: null } as unknown as Live;
}

function course(times: number[], values: number[]): Live {
  const made = live([], [values[values.length - 1] ?? 0]);
  made.history.times = times;
  made.history.values = values;
  return made;
}

const single = (kind: string) => {
  const plot = PLOTS.get(kind) as FlatPlot;
  if (!("content" in plot)) throw new Error(`${kind} has several contents`);
  return plot;
};

function content(kind: string, of: Shown, lives: Live[], memory = new Memory(() => 0)) {
  const made = single(kind).content(of, lives, memory);
  if (made === null) throw new Error(`${kind} has no content`);
  return made;
}

const words = (made: ReturnType<typeof content>, at: At) => readContent(made, at).replaceAll("\u2212", "-");
const head = (made: ReturnType<typeof content>) => csv(tableOf([made]) ?? { header: [], columns: [] });

describe("a time course", () => {
  const times = [0, 1090, 109_000, 109_001];
  const made = () =>
    content("course", shown([], { settings: { window: null } }), [course(times, [1, 2, 3, 4])]);

  it("is over seconds, and its table over the unit of the document", () => {
    expect(words(made(), { x: 1100, y: null })).toBe("t 1.090 s   2.000");
    expect(words(made(), { x: 109_000.6, y: null })).toBe("t 109.001 s   4.000");
    expect(words(made(), { x: null, y: 2 })).toBe("");
    expect(head(made())).toBe("time (ms),activation\n0,1\n1090,2\n109000,3\n109001,4\n");
  });

  it("shows the newest times, the windows of a stimulus and the moment of the past", () => {
    const of = shown([], { settings: { window: 500 }, moment: 300 });
    const { x, marks } = content("course", of, [course([0, 300, 900], [1, 2, 3])]);
    expect(x.range).toEqual([50, 550]);
    expect(marks.map(({ type }) => type)).toEqual(["windows", "line", "moment"]);
    expect(marks[0]).toEqual({ type: "windows", spans: [[20, 80]] });
  });

  it("is ember above the threshold where it is the only one, and no mean", () => {
    const above = (...reduces: ("max" | "mean")[]) => {
      const traces = reduces.map((reduce) => ({ element: "u", port: "activation", reduce, at: [] }));
      const made = content("course", shown(["x"], { settings: { traces } }), [course([0, 2], [-1, 2])]);
      return made.marks.flatMap((mark) => (mark.type === "line" ? [mark.above?.value] : []));
    };
    expect(above("max")).toEqual([0]);
    expect(above("mean")).toEqual([undefined]);
    expect(above("max", "mean")).toEqual([undefined]);
  });

  it("asks for all of its courses, which its legend removes", () => {
    const traces = ["activation", "input"].map((port) => ({
      element: "u",
      port,
      reduce: "max" as const,
      at: [],
    }));
    const of = shown(["x"], { settings: { traces } });
    expect(single("course").wishes(of)).toEqual(traces.map((trace) => ({ type: "trace", ...trace })));
    const [first] = single("course").legend?.(of) ?? [];
    expect(first).toMatchObject({ label: "max of activation", remove: { traces: [traces[1]] } });
    const two = content("course", of, [course([0, 2], [1, 2]), course([1, 2], [5, 6])]);
    expect(words(two, { x: 2, y: null })).toBe("t 0.002 s   max of activation 2.000   max of input 6.000");
    expect(head(two)).toBe("time (ms),max of activation,max of input\n0,1,\n1,,5\n2,2,6\n");
  });
});

describe("curves", () => {
  const lives = [live([X], [-4, 2, 1]), live([X], [0, 1, 0.5])];

  it("have levels in their range, and outputs on the right", () => {
    const made = content("curve", shown(["x"]), lives);
    expect(made.y.range).toEqual([-5.5, 2.5]);
    expect(made.right?.range).toEqual([-0.03, 1.03]);
    expect(made.marks.map(({ type }) => type)).toEqual(["line", "line", "level", "level"]);
    expect(made.marks.map((mark) => mark.type === "line" && mark.above?.value)).toEqual([
      0,
      undefined,
      false,
      false,
    ]);
    expect(words(made, { x: 1.2, y: 0 })).toBe("x 1.000   activation 2.000   output 1.000");
    expect(head(made)).toBe("x (cm),activation,output\n0,-4,0\n1,2,1\n2,1,0.5\n");
  });

  it("are chosen one by one", () => {
    const legend = single("curve").legend?.(shown(["x"])) ?? [];
    expect(legend.map(({ label, on }) => [label, on])).toEqual([
      ["activation", true],
      ["output", true],
      ["input", false],
      ["levels", true],
    ]);
    expect(legend[1]?.press).toEqual({ shown: ["activation", "levels"] });
    const made = content("curve", shown(["x"], { settings: { shown: ["activation"] } }), lives.slice(0, 1));
    expect(made.marks).toHaveLength(1);
    expect(made.y.range).toEqual([-4.5, 2.5]);
    expect(words(made, { x: 2, y: 0 })).toBe("x 2.000   1.000");
  });

  it("keep their range while values get smaller, and one that is fixed", () => {
    const memory = new Memory(() => 0);
    const of = shown(["x"], { settings: { shown: ["activation"] } });
    const before = content("curve", of, [live([X], [0, 8, 1])], memory).y.range;
    expect(content("curve", of, [live([X], [0, 1, 1])], memory).y.range).toEqual(before);
    const fixed = shown(["x"], { settings: { range: [-1, 1] } });
    expect(content("curve", fixed, lives, memory).y.range).toEqual([-1, 1]);
    expect(memory.range).toEqual([-1, 1]);
  });

  it("are drawn along any axis of an array, with its sides before there are values", () => {
    const of = shown(["x", "y"], { settings: { drawn: ["y"] } });
    expect(single("curve").wishes(of)[0]).toMatchObject({ drawn: ["y"], most: 600 });
    expect(content("curve", of, []).x.along).toMatchObject({ name: "y" });
    expect(single("curve").label(of)).toBe("activation, output of u over y");
  });
});

describe("maps", () => {
  const values = [0, 1, 2, 3, 9, 5];

  it("read a value where both positions are known, else the maximum over the other axis", () => {
    const made = content("heat", shown(["x", "y"]), [live([X, Y], values)]);
    expect(made.equal).toBe(true);
    expect(words(made, { x: 1, y: 1 })).toBe("x 1.000   y 1.000   3.000");
    expect(words(made, { x: 2, y: null })).toBe("x 2.000   max 9.000");
    expect(words(made, { x: null, y: 0 })).toBe("y 0.000   max 9.000");
    expect(head(made)).toBe("x (cm),y (cm),activation\n0,0,0\n0,1,1\n1,0,2\n1,1,3\n2,0,9\n2,1,5\n");
  });

  it("have the threshold in the middle of their colours, and nothing before there are values", () => {
    const memory = new Memory(() => 0);
    content("heat", shown(["x", "y"]), [live([X, Y], values)], memory);
    expect(memory.range).toEqual([0, 9]);
    expect(single("heat").content(shown(["x", "y"]), [], memory)).toBeNull();
  });

  it("show weights and kernels over both of their sides", () => {
    const weights = content("weights", shown(["x"]), [live([X, Y], values)]);
    expect(single("weights").note?.(shown(["x"]))).toBe("weights over output and input");
    expect(head(weights).split("\n")[0]).toBe("x (cm),y (cm),weights");
    const lag = { ...X, name: "lag in x" };
    const curve = content("kernel", shown(["x"]), [live([lag], [1, 3, 1])]);
    expect(words(curve, { x: 1, y: null })).toBe("lag in x 1.000   3.000");
    expect(head(curve).split("\n")[0]).toBe("lag in x (cm),weight");
    expect(curve.y.range).toEqual([-0.2, 3.2]);
    expect(content("kernel", shown(["x", "y"]), [live([X, Y], values)]).marks[0]?.type).toBe("map");
  });

  it("over two axes with a unit in common have the same scale on both sides", () => {
    const lives = [live([X, Y], values)];
    for (const kind of ["heat", "weights", "kernel"]) {
      expect(content(kind, shown(["x", "y"]), lives).equal, kind).toBe(true);
    }
    const turn = { ...Y, unit: "deg" };
    expect(content("heat", shown(["x", "y"]), [live([X, turn], values)]).equal).toBe(false);
  });

  it("of pictures read the three channels", () => {
    const of = shown(["x", "y", "channel"]);
    const made = content("picture", of, [
      live(
        [X, Y, CHANNEL],
        Array.from({ length: 18 }, (_, i) => i / 100),
      ),
    ]);
    expect([made.y.down, made.equal]).toEqual([true, true]);
    expect(words(made, { x: 1, y: 0 })).toBe("x 1.000   y 0.000   r 0.060   g 0.070   b 0.080");
    expect(words(made, { x: 1, y: null })).toBe("x 1.000");
    expect(head(made).split("\n")[0]).toBe("x (cm),y (cm),activation red,activation green,activation blue");
  });
});

describe("a space-time plot", () => {
  const rows = () => {
    const made = live([X], [0, 0, 0]);
    [0, 10, 20].forEach((time, i) =>
      made.rows.add({ stream: 1, frame: i, time, values: Float32Array.from([0, i, 2 * i, -i]) }, 3),
    );
    return made;
  };

  it("reads the row at a time; without one that of the moment, without a position the maximum", () => {
    const made = content("space_time", shown(["x"]), [rows()]);
    expect(made.x).toMatchObject({ along: "time", range: [0, 2000] });
    expect(words(made, { x: 12, y: 1 })).toBe("t 0.012 s   x 1.000   2.000");
    expect(words(made, { x: 20, y: null })).toBe("t 0.020 s   max 4.000");
    expect(words(made, { x: null, y: 1 })).toBe("x 1.000   4.000");
    const past = content("space_time", shown(["x"], { moment: 10 }), [rows()]);
    expect(words(past, { x: null, y: 1 })).toBe("x 1.000   2.000");
    expect(head(made).split("\n").slice(0, 3)).toEqual(["time (ms),x (cm),activation", "0,0,0", "0,1,0"]);
  });

  it("has time to the right or down", () => {
    const made = content("space_time", shown(["x"], { settings: { down: true } }), [rows()]);
    expect([made.x.along, made.y.along]).toEqual([X, "time"]);
    expect(made.y.down).toBe(true);
    expect(words(made, { x: 1, y: 20 })).toBe("t 0.020 s   x 1.000   4.000");
  });
});

describe("a phase plot", () => {
  it("reads the nearest sample, and has a line where the rate is 0", () => {
    const made = content("phase", shown([]), [course([0, 10, 20], [0, 5, 5])]);
    expect([made.x.label, made.y.label]).toEqual(["activation", "rate of change (1/ms)"]);
    expect(made.marks.map(({ type }) => type)).toEqual(["level", "tail"]);
    expect(words(made, { x: 2.4, y: 0.5 })).toBe("t 0.005 s   2.500   0.500");
    expect(words(made, { x: 5, y: null })).toBe("");
    expect(head(made)).toBe("time (ms),activation,rate of change (1/ms)\n5,2.5,0.5\n15,5,0\n");
  });
});

describe("small multiples", () => {
  const plot = PLOTS.get("multiples") as Extract<FlatPlot, { contents: unknown }>;
  const several = (axes: string[]) => shown(axes, { others: [element("v", axes)] });
  const table = (axes: string[], lives: Live[]) => {
    const made = plot.contents(several(axes), lives, new Memory(() => 0)).flatMap((one) => one ?? []);
    return csv(tableOf(made, ["u", "v"]) ?? { header: [], columns: [] });
  };

  it("share their ranges and colours", () => {
    const lives = [live([X], [0, 1, 2]), live([X], [0, 9, 2])];
    const [one, other] = plot.contents(several(["x"]), lives, new Memory(() => 0));
    expect(one?.y.range).toEqual(other?.y.range);
    expect(one?.y.range[1]).toBeGreaterThanOrEqual(9);
    const maps = [live([X, Y], [0, 1, 2, 3, 4, 5]), live([X, Y], [0, 1, 2, 3, 4, 50])];
    const [first, second] = plot.contents(several(["x", "y"]), maps, new Memory(() => 0));
    expect(first?.marks[0]).toMatchObject({ colors: { range: [0, 50] } });
    expect(second?.marks[0]).toMatchObject({ colors: { range: [0, 50] } });
  });

  it("have one column for each element", () => {
    expect(table(["x"], [live([X], [0, 1, 2]), live([X], [3, 4, 5])])).toBe(
      "x (cm),u,v\n0,0,3\n1,1,4\n2,2,5\n",
    );
    expect(table([], [course([0, 1], [1, 2]), course([0, 1], [3, 4])])).toBe("time (ms),u,v\n0,1,3\n1,2,4\n");
    const maps = [live([X, Y], [0, 1, 2, 3, 4, 5]), live([X, Y], [6, 7, 8, 9, 10, 11])];
    expect(table(["x", "y"], maps).split("\n").slice(0, 2)).toEqual(["x (cm),y (cm),u,v", "0,0,0,6"]);
  });
});
