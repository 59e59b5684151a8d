import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Painter } from "./painter";

let frames: ((now: number) => void)[] = [];
const next = (now = 0) => frames.splice(0).forEach((frame) => frame(now));

beforeEach(() =>
  vi.stubGlobal("requestAnimationFrame", (frame: (now: number) => void) => frames.push(frame)),
);
afterEach(() => {
  frames = [];
  vi.unstubAllGlobals();
});

test("only the last request of an owner is drawn", () => {
  const painter = new Painter();
  const [owner, drawn] = [{}, [] as string[]];
  painter.wish(owner, () => drawn.push("old"));
  painter.wish(owner, () => drawn.push("new"));
  next();
  expect(drawn).toEqual(["new"]);
});

test("a held painter draws those that have waited for almost a second, the others afterwards", () => {
  const clock = vi.spyOn(performance, "now");
  const at = (now: number) => {
    clock.mockImplementation(() => now);
    next(now);
  };
  const after = vi.fn();
  const painter = new Painter(after);
  const drawn: number[] = [];
  at(10_000);
  painter.wish({}, () => drawn.push(1));
  painter.hold(true);
  for (let now = 10_020; now <= 10_840; now += 20) {
    at(now);
  }
  expect(drawn).toEqual([]);
  expect(after).not.toHaveBeenCalled();
  at(10_880);
  expect(drawn).toEqual([1]);
  expect(after).toHaveBeenCalledOnce();
  painter.wish({}, () => drawn.push(2));
  at(10_900);
  expect(drawn).toEqual([1]);
  painter.hold(false);
  at(10_920);
  expect(drawn).toEqual([1, 2]);
  clock.mockRestore();
});

test("a removed owner is not drawn", () => {
  const painter = new Painter();
  const owner = {};
  const draw = vi.fn();
  painter.wish(owner, draw);
  painter.forget(owner);
  next();
  expect(draw).not.toHaveBeenCalled();
});

test("all of many owners are drawn equally often, even in a slow browser", () => {
  const painter = new Painter();
  const owners = Array.from({ length: 30 }, () => ({}));
  const times = owners.map(() => 0);
  const wish = (i: number) =>
    painter.wish(owners[i] as object, () => {
      times[i] = (times[i] ?? 0) + 1;
    });
  let now = 0;
  for (let frame = 0; frame < 60; frame++) {
    owners.forEach((_, i) => wish(i));
    now += 60;
    next(now);
  }
  expect(Math.min(...times)).toBeGreaterThan(2);
  expect(Math.max(...times) - Math.min(...times)).toBeLessThanOrEqual(1);
});

test("on a slow machine each of 200 boxes is drawn at least once a second", () => {
  const clock = vi.spyOn(performance, "now");
  const painter = new Painter();
  const drawn = new Map<number, number[]>();
  let now = 10_000;
  clock.mockImplementation(() => now);
  for (let frame = 0; frame < 60; frame++) {
    for (let box = 0; box < 200; box++) {
      painter.wish(drawnBy(box), () => {
        now += 1; // drawing takes its time
        drawn.set(box, [...(drawn.get(box) ?? []), now]);
      });
    }
    now += 300;
    next(now);
  }
  clock.mockRestore();
  expect(drawn.size).toBe(200);
  const gaps = [...drawn.values()].flatMap((times) => times.slice(1).map((time, i) => time - times[i]!));
  expect(Math.max(...gaps)).toBeLessThanOrEqual(1000);
});

const owners: object[] = [];
const drawnBy = (box: number): object => (owners[box] ??= {});
