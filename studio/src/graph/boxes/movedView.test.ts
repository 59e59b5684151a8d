import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { MovedView } from "./movedView";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

const at = (x: number) => ({ x, y: 0, zoom: 1 });

function begun() {
  const [shifted, sent] = [[] as number[], [] as number[]];
  const view = new MovedView(
    ({ x }) => shifted.push(x),
    ({ x }) => sent.push(x),
  );
  return { view, shifted, sent };
}

test("a hand shifts the picture at once, and the view is sent some times a second", () => {
  const { view, shifted, sent } = begun();
  view.hold(true);
  for (let x = 1; x <= 60; x++) {
    view.change(at(x));
    vi.advanceTimersByTime(16);
  }
  expect(shifted).toHaveLength(60);
  expect(sent.length).toBeLessThanOrEqual(10);
  expect(sent.length).toBeGreaterThanOrEqual(6);
});

test("the end of a movement is sent at once and once, and two movements do not mix", () => {
  const { view, sent } = begun();
  view.hold(true);
  view.change(at(1));
  view.change(at(2));
  expect(sent).toEqual([]);
  view.hold(false);
  expect(sent).toEqual([2]);
  view.hold(true);
  view.change(at(3));
  view.flush();
  view.hold(false);
  vi.runAllTimers();
  expect(sent).toEqual([2, 3]);
});

test("a view that the page chooses is sent at once", () => {
  const { view, shifted, sent } = begun();
  view.change(at(5));
  view.change(at(6));
  expect([shifted, sent]).toEqual([[], [5, 6]]);
  expect(view.now).toEqual(at(6));
});
