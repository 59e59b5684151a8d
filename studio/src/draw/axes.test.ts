import { expect, it } from "vitest";
import { drawAxes, layout, nameOf } from "./axes";
import type { Content, PlotSide } from "./content";
import { isSmall, paperInk, widthOf } from "./ink";
import { SvgContext } from "./svg";

const values: PlotSide = {
  along: null,
  label: "a very long name of some values of a port",
  range: [-5, 1000],
};
const times = (range: readonly [number, number]): PlotSide => ({ along: "time", unit: "ms", range });
const plot = (x: PlotSide, y: PlotSide, more: Partial<Content> = {}): Content => ({
  x,
  y,
  marks: [],
  ...more,
});

type Text = { text: string; x: number; y: number; anchor: string; turned: boolean };

function textsOf(content: Content, width: number, height: number): Text[] {
  const ink = paperInk(1, isSmall(width, height));
  const ctx = new SvgContext();
  drawAxes(
    ctx as unknown as CanvasRenderingContext2D,
    content,
    layout(content, ink, width, height),
    ink,
    width,
  );
  const found = ctx.content.matchAll(/<text x="(.*?)" y="(.*?)" text-anchor="(\w+)"(.*?)>(.*)<\/text>/g);
  return [...found].map(([, x, y, anchor = "", rest = "", text = ""]) => ({
    text,
    x: Number(x),
    y: Number(y),
    anchor,
    turned: rest.includes("matrix"),
  }));
}

it("time is written in seconds, a unit of the document's own as it is", () => {
  expect(nameOf(times([0, 1]))).toBe("time (s)");
  expect(nameOf({ ...times([0, 1]), unit: "abstract" })).toBe("time (abstract)");
  const texts = textsOf(plot(times([107_000, 109_000]), values), 400, 300).map(({ text }) => text);
  for (const text of ["107.0", "108.5", "109.0"]) expect(texts).toContain(text);
});

it("numbers side by side stay apart and inside, in plots of all sizes", () => {
  for (const [width, height] of [
    [160, 100],
    [110, 80],
    [240, 180],
    [900, 300],
  ] as const) {
    for (const range of [
      [0, 2000],
      [107_000, 109_000],
      [0, 3.5],
    ] as const) {
      const size = isSmall(width, height) ? 10 : 11;
      const below = textsOf(plot(times(range), values), width, height).filter(
        ({ anchor, turned, text }) => anchor === "middle" && !turned && text !== "time (s)",
      );
      expect(below.length).toBeGreaterThanOrEqual(1);
      below.forEach(({ x, text }, i) => {
        const reach = widthOf(text, size) / 2;
        expect(x - reach).toBeGreaterThanOrEqual(0);
        expect(x + reach).toBeLessThanOrEqual(width);
        const before = below[i - 1];
        if (before !== undefined) {
          expect(x - reach).toBeGreaterThan(before.x + widthOf(before.text, size) / 2);
        }
      });
    }
  }
});

it("a name is cut where a side has no room for it", () => {
  const turned = textsOf(plot(times([0, 1]), values), 260, 150).filter((text) => text.turned);
  expect(turned.map(({ text }) => text)).toEqual([expect.stringMatching(/^a very long.*…$/)]);
});

it("both sides of an equal plot have the same scale", () => {
  const x = { along: null, range: [0, 20] as const };
  const { box, ...scales } = layout(
    plot(x, { ...x, range: [0, 10] }, { equal: true }),
    paperInk(1),
    500,
    500,
  );
  expect(box.width / box.height).toBeCloseTo(2, 1);
  expect(scales.x.place(20)).toBe(box.left + box.width);
  expect(scales.y.place(10)).toBe(box.top);
  expect(scales.x.value(scales.x.place(7))).toBeCloseTo(7);
});

it("a side downwards begins at the top, and values on the right have a scale of their own", () => {
  const y = { along: null, range: [0, 10] as const, down: true };
  const placed = layout(
    plot(times([0, 1]), y, { right: { along: null, range: [0, 1] } }),
    paperInk(2),
    600,
    400,
  );
  expect(placed.y.place(0)).toBe(placed.box.top);
  expect(placed.right?.place(1)).toBe(placed.box.top);
});
