import { expect, it } from "vitest";
import { share } from "./placement";

it("a new plot is placed beside others if there is room", () => {
  expect(share({ width: 900, height: 300 })).toBe("right");
  expect(share({ width: 500, height: 600 })).toBe("below");
  expect(share({ width: 500, height: 300 })).toBe("within");
});
