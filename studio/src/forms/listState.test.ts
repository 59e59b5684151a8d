import { expect, test } from "vitest";
import { fakeForm } from "../architecture/fakes";
import { listChoices, listState } from "./listState";

const WINDOWS = fakeForm("windows", "parts", { optional: true, if_none: "always", if_empty: "never" });

test("null, an empty list and a list with parts are three states", () => {
  expect([null, undefined, [], [{ kind: "Window" }]].map(listState)).toEqual([
    "absent",
    "absent",
    "empty",
    "listed",
  ]);
});

test("a parameter with words for null and for an empty list offers both, and shows a list with parts", () => {
  expect(listChoices(WINDOWS, "absent").map(({ label }) => label)).toEqual(["always", "never"]);
  expect(listChoices(WINDOWS, "empty")).toEqual(listChoices(WINDOWS, "absent"));
  expect(listChoices(WINDOWS, "listed").at(-1)).toEqual({ value: "listed", label: "as listed" });
});

test("a list that cannot be null, such as kernels, offers no choice", () => {
  expect(listChoices(fakeForm("kernel", "parts"), "empty")).toEqual([]);
  expect(listChoices({ ...WINDOWS, if_empty: "" }, "empty")).toEqual([]);
});
