import { expect, it } from "vitest";
import { activationScale, curveColor, inOrder, portColor, scale, SCALES } from "./colors";

const lightness = (table: Uint8ClampedArray, i: number) =>
  0.3 * (table[4 * i] ?? 0) + 0.59 * (table[4 * i + 1] ?? 0) + 0.11 * (table[4 * i + 2] ?? 0);

it("lightness increases along every scale, so that it can be read without hues", () => {
  for (const { name } of SCALES.filter((other) => other.name !== "diverging")) {
    const table = scale(name).light;
    for (let i = 8; i < 256; i += 8) {
      expect(lightness(table, i), `${name} ${i}`).toBeGreaterThan(lightness(table, i - 8));
    }
  }
});

it("the diverging scale is lightest at its centre", () => {
  const table = scale("diverging").light;
  expect(lightness(table, 128)).toBeGreaterThan(240);
  expect(lightness(table, 0)).toBeLessThan(80);
  expect(lightness(table, 255)).toBeLessThan(80);
});

const colorAt = (table: Uint8ClampedArray, i: number) => [...table.slice(4 * i, 4 * i + 3)];
const WHITE = [255, 255, 255];

it("activation takes all of its colours on each side of the threshold, which is white", () => {
  for (const [lower, upper, threshold] of [
    [-10, 4, 0],
    [-3, 9, 1],
    [-10.3, 3.7, 0.1],
  ] as const) {
    const table = activationScale(lower, upper, threshold);
    const middle = Math.round((255 * (threshold - lower)) / (upper - lower));
    expect(colorAt(table, middle)).toEqual(WHITE);
    expect(colorAt(table, 0)).toEqual(colorAt(scale("diverging").light, 0));
    expect(colorAt(table, 255)).toEqual(colorAt(scale("diverging").light, 255));
  }
});

it("a value just above the threshold of a field at rest is pale", () => {
  const table = activationScale(-9, 0.5, 0);
  expect(lightness(table, 255)).toBeGreaterThan(210);
  expect(lightness(activationScale(-0.5, 9, 0), 0)).toBeGreaterThan(210);
});

it("a range on one side of the threshold has the colours of that side", () => {
  expect(colorAt(activationScale(1, 5, 0), 0)).not.toEqual(WHITE);
  expect(colorAt(activationScale(-5, -1, 0), 0)).toEqual(colorAt(scale("diverging").light, 0));
});

it("a port has the same colour in every plot", () => {
  expect(inOrder(["interaction", "output", "other", "activation"])).toEqual([
    "activation",
    "output",
    "interaction",
    "other",
  ]);
  expect(portColor("output", ["output"], "light")).toBe(
    portColor("output", ["activation", "output"], "light"),
  );
  expect(portColor("other", ["output", "other"], "dark")).toBe(curveColor(4, "dark"));
});
