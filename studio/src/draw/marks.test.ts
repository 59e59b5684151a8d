import { expect, it } from "vitest";
import { layout } from "./axes";
import type { Content } from "./content";
import { paperInk } from "./ink";
import { drawMarks } from "./marks";
import { SvgContext } from "./svg";

it("a curve with a gap among many samples in a column of pixels continues after it", () => {
  const xs = Array.from({ length: 30_000 }, (_, i) => i);
  const ys = xs.map((i) => (i > 10_000 && i < 10_100 ? NaN : Math.sin(i / 7)));
  const color = { light: "#0b6cb3", dark: "#62b5f0" };
  const content: Content = {
    x: { along: "time", unit: "ms", range: [0, 30_000] },
    y: { along: null, label: "", range: [-1, 1] },
    marks: [{ type: "line", label: "", color, width: 1, xs, ys }],
  };
  const ink = paperInk(1);
  const ctx = new SvgContext();
  const place = layout(content, ink, 300, 200);
  drawMarks({ ctx: ctx as unknown as CanvasRenderingContext2D, content, layout: place, ink });
  expect(ctx.content).not.toContain("NaN");
  const ends = [...ctx.content.matchAll(/[ML](-?[\d.]+) /g)].map(([, x]) => Number(x));
  expect(Math.max(...ends)).toBeGreaterThan(place.box.left + 0.95 * place.box.width);
});
