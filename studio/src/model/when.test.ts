import { expect, it } from "vitest";

import { whenText } from "./when";

it("times of the past are written in words", () => {
  const now = new Date(2026, 4, 12, 18, 0);
  expect(whenText("2026-05-12T14:05:00", now)).toBe("today at 14:05");
  expect(whenText("2026-05-11T09:30:59", now)).toBe("yesterday at 9:30");
  expect(whenText("2026-05-03T00:07:00", now)).toBe("on 3 May 2026 at 0:07");
  expect(whenText("some time", now)).toBe("some time");
});
