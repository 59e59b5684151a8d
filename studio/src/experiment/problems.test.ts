import { expect, test } from "vitest";

import { otherProblems, problemsAt } from "./problems";

const PROBLEMS = ["conditions.a.of", "conditions.ab", "actions.0: u", "limit", ""].map((where) => ({
  what: "is wrong",
  where,
}));

test("a card has the problems of its part, and not those of a longer name", () => {
  expect(problemsAt(PROBLEMS, "conditions.a")).toEqual([PROBLEMS[0]]);
  expect(problemsAt(PROBLEMS, "actions.0")).toEqual([PROBLEMS[2]]);
});

test("the rest concerns the whole experiment", () => {
  const places = ["conditions.a", "conditions.ab", "actions.0"];
  expect(otherProblems(PROBLEMS, places)).toEqual(PROBLEMS.slice(3));
});
