import { expect, it } from "vitest";
import { LIVE, mostSamples } from "./boxes";

it("a live curve has a sample for each pixel also in a magnified view, a map as many as it has room for", () => {
  expect(mostSamples(1, LIVE.width)).toBe(2 * LIVE.width);
  expect(mostSamples(2, LIVE.width)).toBeLessThan(LIVE.width);
});
