import { afterEach, beforeEach, expect, test, vi } from "vitest";

import { Gesture, newGesture } from "./gesture";

type Sent = { value: number; gesture: number; answer: () => void };

function setup() {
  const sent: Sent[] = [];
  const frames: (() => void)[] = [];
  const settled = vi.fn();
  const gesture = new Gesture<number>(
    (value, number) => new Promise<void>((answer) => sent.push({ value, gesture: number, answer })),
    settled,
    (draw) => frames.push(draw),
  );
  const draw = () => frames.splice(0).forEach((frame) => frame());
  const answer = async () => {
    sent[sent.length - 1]?.answer();
    await vi.advanceTimersByTimeAsync(0);
  };
  return { sent, settled, gesture, draw, answer };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

test("each gesture has its own number, never 0", () => {
  const first = newGesture();
  expect(newGesture()).toBe(first + 1);
  expect(first).toBeGreaterThan(0);
});

test("each frame sends one message, with the newest value", () => {
  const { sent, gesture, draw } = setup();
  gesture.move(1);
  gesture.move(2);
  gesture.move(3);
  expect(sent).toHaveLength(0);
  draw();
  expect(sent.map((s) => s.value)).toEqual([3]);
});

test("while a message is unanswered, only the newest value waits, and is sent after the answer", async () => {
  const { sent, gesture, draw, answer } = setup();
  gesture.move(1);
  draw();
  gesture.move(2);
  gesture.move(3);
  draw();
  expect(sent).toHaveLength(1);
  await answer();
  draw();
  expect(sent.map((s) => s.value)).toEqual([1, 3]);
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
});

test("the last value of a drag is sent, and the drag ends with its answer", async () => {
  const { sent, settled, gesture, draw, answer } = setup();
  gesture.move(1);
  draw();
  gesture.move(2);
  gesture.end();
  await answer();
  expect(settled).not.toHaveBeenCalled();
  draw();
  await answer();
  expect(sent.map((s) => s.value)).toEqual([1, 2]);
  expect(settled).toHaveBeenCalledTimes(1);
});

test("the gesture of a slider that is held still does not end", async () => {
  const { settled, gesture, draw, answer } = setup();
  gesture.move(1);
  draw();
  await answer();
  expect(settled).not.toHaveBeenCalled();
  gesture.end();
  expect(settled).toHaveBeenCalledTimes(1);
});

test("keys in quick succession are one gesture; a key after a pause starts another", async () => {
  const { sent, gesture, draw, answer } = setup();
  for (const [value, pause] of [
    [1, 100],
    [2, 600],
    [3, 0],
  ] as const) {
    gesture.nudge(value);
    draw();
    await answer();
    await vi.advanceTimersByTimeAsync(pause);
  }
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
  expect(sent[2]?.gesture).not.toBe(sent[0]?.gesture);
});
