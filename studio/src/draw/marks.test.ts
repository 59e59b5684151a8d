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

it("a curve has the colour of its port below the threshold, and above it ember with a glow", () => {
  const [blue, ember] = [
    { light: "#0b6cb3", dark: "#62b5f0" },
    { light: "#c2410c", dark: "#ff8a4c" },
  ];
  const drawn = (ys: number[]) => {
    const content: Content = {
      x: { along: null, label: "", range: [0, 3] },
      y: { along: null, label: "", range: [-2, 2] },
      marks: [
        {
          type: "line",
          label: "",
          color: blue,
          above: { value: 0.5, color: ember },
          width: 1,
          xs: [0, 1, 2, 3],
          ys,
        },
      ],
    };
    const [ink, ctx] = [paperInk(1), new SvgContext()];
    const place = layout(content, ink, 300, 200);
    drawMarks({ ctx: ctx as unknown as CanvasRenderingContext2D, content, layout: place, ink });
    const bands = [...ctx.content.matchAll(/<path d="M[\d.]+ ([\d.]+)h[\d.]+v([\d.]+)h/g)].map((band) =>
      band.slice(1),
    );
    return { place, svg: ctx.content, bands: bands.map(([top, height]) => [Number(top), Number(height)]) };
  };
  const { place, svg, bands } = drawn([-1, 1, 1, -1]);
  const { top, height } = place.box;
  const threshold = place.y.place(0.5);
  expect(bands).toEqual([
    [top, height],
    [threshold, top + height - threshold],
    [top, threshold - top],
  ]);
  expect(svg.match(/stroke="#0b6cb3"/g)).toHaveLength(1);
  expect(svg.match(/stroke="#c2410c"/g)).toHaveLength(1);
  expect(svg).toMatch(/fill="#c2410c" opacity="0.13"/);
  expect(svg, "the glow ends at the threshold").toMatch(new RegExp(`M\\d+ ${threshold}L.*Z" fill="#c2410c"`));
});
