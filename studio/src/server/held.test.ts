import { afterEach, beforeEach, expect, test, vi } from "vitest";

import { Held, newGesture } from "./held";

function setup() {
  const sent: { value: number; gesture: number; answer: () => void }[] = [];
  const shown: (number | null)[] = [];
  const held = new Held<number>(
    (value, gesture) => new Promise<void>((answer) => sent.push({ value, gesture, answer })),
    (value) => shown.push(value),
  );
  const answer = async () => {
    sent.at(-1)?.answer();
    await vi.advanceTimersByTimeAsync(0);
  };
  const values = () => sent.map(({ value }) => value);
  return { sent, shown, held, answer, values };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

test("each gesture has its own number, never 0", () => {
  const first = newGesture();
  expect(newGesture()).toBe(first + 1);
  expect(first).toBeGreaterThan(0);
});

test("while a message is unanswered, only the newest value waits, and is sent after the answer", async () => {
  const { sent, shown, held, answer, values } = setup();
  for (const value of [1, 2, 3]) held.move(value);
  expect([values(), shown]).toEqual([[1], [1, 2, 3]]);
  await answer();
  await answer();
  expect(values()).toEqual([1, 3]);
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
});

test("the last value is sent with the number of its gesture, and shown until its answer", async () => {
  const { sent, shown, held, answer, values } = setup();
  held.move(1);
  held.move(2);
  held.release();
  await answer();
  expect([values(), shown]).toEqual([
    [1, 2],
    [1, 2],
  ]);
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
  await answer();
  expect(shown).toEqual([1, 2, null]);
});

test("what is held still stays in the hand, and a second gesture is another one", async () => {
  const { sent, shown, held, answer } = setup();
  held.move(1);
  await answer();
  expect([shown, held.isDown]).toEqual([[1], true]);
  held.release();
  expect([shown, held.isDown]).toEqual([[1, null], false]);
  held.move(2);
  expect(sent[1]?.gesture).not.toBe(sent[0]?.gesture);
});

test("two hands do not wait for each other", () => {
  const [one, other] = [setup(), setup()];
  one.held.move(1);
  other.held.move(2);
  expect([one.values(), other.values()]).toEqual([[1], [2]]);
  expect(one.sent[0]?.gesture).not.toBe(other.sent[0]?.gesture);
});

test("keys in quick succession are one gesture; a key after a pause starts another", async () => {
  const { sent, shown, held, answer } = setup();
  for (const [value, pause] of [
    [1, 100],
    [2, 600],
    [3, 0],
  ] as const) {
    held.nudge(value);
    await answer();
    await vi.advanceTimersByTimeAsync(pause);
  }
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
  expect(sent[2]?.gesture).not.toBe(sent[0]?.gesture);
  expect(shown).toEqual([1, 2, null, 3]);
});

test("keys during a drag belong to it, and the drag does not end by their pause", async () => {
  const { sent, held, answer } = setup();
  held.nudge(1);
  held.move(2);
  await vi.advanceTimersByTimeAsync(600);
  expect(held.isDown).toBe(true);
  await answer();
  expect(sent[1]?.gesture).toBe(sent[0]?.gesture);
});

test("a message that fails does not keep the next one from being sent", async () => {
  const sent: number[] = [];
  const held = new Held<number>((value) => {
    sent.push(value);
    return value === 1 ? Promise.reject(new Error("lost")) : Promise.resolve();
  });
  process.once("unhandledRejection", () => {});
  held.move(1);
  await vi.advanceTimersByTimeAsync(0);
  held.move(2);
  expect(sent).toEqual([1, 2]);
});
