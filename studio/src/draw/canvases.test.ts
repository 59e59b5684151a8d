import { expect, test } from "vitest";
import { hasGraphicsCard } from "./canvases";

test("a browser that refuses WebGL without a performance caveat has no graphics card", () => {
  const asked: unknown[] = [];
  let lost = 0;
  const card = { getExtension: () => ({ loseContext: () => lost++ }) };
  const canvas = (context: unknown) =>
    ({
      getContext: (...what: unknown[]) => {
        asked.push(what);
        return context;
      },
    }) as unknown as HTMLCanvasElement;
  expect(hasGraphicsCard(canvas(null))).toBe(false);
  expect(hasGraphicsCard(canvas(card))).toBe(true);
  expect(lost, "the context is given back").toBe(1);
  expect(asked[0]).toEqual(["webgl", { failIfMajorPerformanceCaveat: true }]);
});
