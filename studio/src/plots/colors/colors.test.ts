import { expect, it } from "vitest";
import { centred, curveColor, inOrder, portColor, scale, SCALES } from "./colors";

const lightness = (table: Uint8ClampedArray, i: number) =>
  0.3 * (table[4 * i] ?? 0) + 0.59 * (table[4 * i + 1] ?? 0) + 0.11 * (table[4 * i + 2] ?? 0);

it("lightness increases along every scale, so that it can be read without hues", () => {
  for (const { name } of SCALES.filter((other) => other.name !== "diverging")) {
    const table = scale(name);
    for (let i = 8; i < 256; i += 8) {
      expect(lightness(table, i), `${name} ${i}`).toBeGreaterThan(lightness(table, i - 8));
    }
  }
});

it("the diverging scale is lightest at its centre", () => {
  const table = scale("diverging");
  expect(lightness(table, 128)).toBeGreaterThan(240);
  expect(lightness(table, 0)).toBeLessThan(80);
  expect(lightness(table, 255)).toBeLessThan(80);
});

it("a part of the diverging scale keeps its centre, and is equally steep on both sides", () => {
  const piece = centred(scale("diverging"), -5, 2.5, 0);
  expect(lightness(piece, 170)).toBeGreaterThan(240);
  expect([...piece.slice(0, 3)]).toEqual([...scale("diverging").slice(0, 3)]);
  expect([...piece.slice(4 * 255, 4 * 255 + 3)]).toEqual([...scale("diverging").slice(4 * 191, 4 * 191 + 3)]);
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
