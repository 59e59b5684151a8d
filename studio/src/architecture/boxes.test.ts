import { expect, it } from "vitest";
import { LIVE, mostSamples } from "./boxes";

it("a live curve has a sample for each pixel of a magnified view, a map fewer", () => {
  expect(mostSamples(1, LIVE.width)).toBe(2 * LIVE.width);
  expect(mostSamples(2, LIVE.width)).toBeLessThan(LIVE.width);
});
