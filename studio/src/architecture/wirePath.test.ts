import { expect, test } from "vitest";

import { direct } from "./wirePath";

const FROM = { x: 100, y: 25 };

test("a wire that is moved is one curve to the right", () => {
  const { path, middle } = direct(FROM, { x: 300, y: 75 });
  expect(path).toBe("M100,25 L100,25 C200,25 200,75 300,75 L300,75");
  expect(middle).toEqual({ x: 200, y: 50 });
});

test("a wire that is moved to the left goes around below both ends", () => {
  expect(direct(FROM, { x: 0, y: 75 }).middle.y).toBeGreaterThan(100);
});
