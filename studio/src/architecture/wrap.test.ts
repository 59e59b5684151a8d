import { describe, expect, it } from "vitest";
import { PANEL } from "./layout";
import type { Point, Size } from "../model/rects";
import { wrapped } from "./wrap";

function chain(n: number): [Map<string, Point>, Map<string, Size>] {
  const ids = Array.from({ length: n }, (_, i) => `e${i}`);
  return [
    new Map(ids.map((id, i) => [id, { x: 200 * i, y: 0 }])),
    new Map(ids.map((id) => [id, { width: 160, height: 100 }])),
  ];
}

describe("lines", () => {
  it("leave a narrow graph unchanged", () => {
    const [places, sizes] = chain(3);
    expect(wrapped(places, sizes, PANEL)).toBe(places);
  });

  it("break a long chain, in order, without overlapping boxes", () => {
    const [places, sizes] = chain(24);
    const out = [...wrapped(places, sizes, PANEL)];
    expect(out).toHaveLength(24);
    const width = Math.max(...out.map(([, p]) => p.x)) + 160;
    const height = Math.max(...out.map(([, p]) => p.y)) + 100;
    expect(width / height).toBeLessThan(4.5);
    for (const [i, [, a]] of out.entries()) {
      for (const [, b] of out.slice(i + 1)) {
        expect(Math.abs(a.x - b.x) >= 160 || Math.abs(a.y - b.y) >= 100).toBe(true);
        expect(a.y < b.y || (a.y === b.y && a.x < b.x)).toBe(true);
      }
    }
  });

  it("of a narrow canvas are shorter", () => {
    const [places, sizes] = chain(12);
    const width = (panel: Size) => Math.max(...[...wrapped(places, sizes, panel).values()].map((p) => p.x));
    expect(width({ width: 300, height: 800 })).toBeLessThan(width({ width: 1200, height: 400 }) / 2);
  });

  it("become columns where many boxes lie below each other", () => {
    const [row, sizes] = chain(24);
    const places = new Map([...row].map(([id, { x, y }]) => [id, { x: y, y: x }]));
    const out = [...wrapped(places, sizes, PANEL).values()];
    expect(new Set(out.map((p) => p.x)).size).toBeGreaterThan(2);
  });
});
