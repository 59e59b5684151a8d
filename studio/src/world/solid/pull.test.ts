import { expect, it } from "vitest";

import type { Answer, ToServer } from "../../protocol";
import { force, Puller } from "./pull";

it("pulls towards the pointer, more the farther it is, and never above the largest force", () => {
  expect(force([0, 0, 0], [0.1, 0, 0])).toEqual([40, 0, 0]);
  const far = force([1, 1, 1], [1, 4, 5]);
  expect(Math.hypot(...far)).toBeCloseTo(100, 9);
  expect(far[2] / far[1]).toBeCloseTo(4 / 3, 9);
  expect(force([1, 2, 3], [1, 2, 3])).toEqual([0, 0, 0]);
});

it("asks for one push at a time, skips older ones, and always ends it", async () => {
  const asked: ToServer[] = [];
  const waiting: ((answer: Answer) => void)[] = [];
  const puller = new Puller(
    (message) => {
      asked.push(message);
      return new Promise((resolve) => waiting.push(resolve));
    },
    () => undefined,
  );
  const answer = async (what = "") => {
    waiting.shift()?.({ problems: what === "" ? [] : [{ what }] } as unknown as Answer);
    await new Promise((resolve) => setTimeout(resolve));
  };
  puller.pull("arm", [1, 0, 0]);
  puller.pull("arm", [2, 0, 0]);
  puller.pull("arm", [3, 0, 0]);
  await answer();
  puller.release("arm");
  await answer("it cannot be pushed");
  expect(puller.refused).toBe("it cannot be pushed");
  await answer();
  expect(asked.map((message) => (message.type === "push_body" ? message.force[0] : null))).toEqual([1, 3, 0]);
  expect([puller.refused, waiting.length]).toEqual(["", 0]);
});
