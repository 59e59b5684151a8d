import { expect, test } from "vitest";
import { countText, isWarning } from "./severity";

const problem = { what: "a loop without a state" };
const warning = { what: "the stimulus is never on", severity: "warning" as const };

test("only entries of severity warning are warnings", () => {
  expect(isWarning(warning)).toBe(true);
  expect(isWarning(problem)).toBe(false);
  expect(isWarning({ what: "", severity: "problem" })).toBe(false);
});

test("problems and warnings are counted separately", () => {
  expect(countText([])).toBe("");
  expect(countText([problem])).toBe("1 problem");
  expect(countText([warning])).toBe("1 warning");
  expect(countText([problem, warning, warning])).toBe("1 problem, 2 warnings");
});
