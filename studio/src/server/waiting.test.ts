import { beforeEach, expect, test, vi } from "vitest";

import type { Checked, ListedProblem } from "../protocol";
import { useStudio } from "./store";
import { withoutNew } from "./waiting";

const open = { source: "1", source_port: "output", target: "", target_port: "" };
const loose: ListedProblem = { where: "left", what: "nothing reads it", severity: "warning", wire: open };
const sign: ListedProblem = { where: "u", what: "is always on", severity: "warning" };
const missing: ListedProblem = { where: "g", what: "nothing is connected", wire: open };
const checked = (...problems: ListedProblem[]): Checked => ({ type: "checked", version: 1, problems });

beforeEach(() => {
  vi.useFakeTimers();
  useStudio.setState(({ session }) => ({ session: session + 1 }));
});

test("a new warning of a missing connection waits 4 s, other problems do not", () => {
  const show = vi.fn();
  const message = checked(loose, sign, missing);
  expect(withoutNew(message, [], show).problems).toEqual([sign, missing]);
  vi.advanceTimersByTime(3900);
  expect(show).not.toHaveBeenCalled();
  vi.advanceTimersByTime(200);
  expect(show).toHaveBeenCalledExactlyOnceWith(message);
});

test("it waits again after each edit, and one that is shown stays", () => {
  const show = vi.fn();
  withoutNew(checked(loose), [], show);
  vi.advanceTimersByTime(3000);
  const other = { ...loose, where: "right", wire: { ...open, source: "2" } };
  expect(withoutNew(checked(loose, other), [loose], show).problems).toEqual([loose]);
  vi.advanceTimersByTime(3900);
  expect(show).not.toHaveBeenCalled();
  expect(withoutNew(checked(), [loose], show).problems).toEqual([]);
  vi.advanceTimersByTime(10_000);
  expect(show).not.toHaveBeenCalled();
});

test("a warning that is shown stays with errors, at each edit, and with another name", () => {
  const show = vi.fn();
  const error: ListedProblem = { where: "u", what: "does not fit", severity: "problem" };
  withoutNew(checked(loose), [loose], show);
  for (let edits = 0; edits < 3; edits++) {
    // an edit shows the error alone
    expect(withoutNew(checked(error, loose), [error], show).problems).toEqual([error, loose]);
  }
  expect(withoutNew(checked(error), [error], show).problems).toEqual([error]);
  const renamed = { ...loose, where: "another" };
  expect(withoutNew(checked(renamed), [error], show).problems).toEqual([renamed]);
  withoutNew(checked(), [renamed], show);
  expect(withoutNew(checked(loose), [], show).problems, "it was corrected between").toEqual([]);
});

test("a warning that waited is known when it is shown, and to its own document alone", () => {
  const show = vi.fn();
  withoutNew(checked(loose), [], show);
  vi.advanceTimersByTime(4100);
  expect(withoutNew(checked(loose), [], show).problems).toEqual([loose]);
  useStudio.setState({ session: -7 });
  expect(withoutNew(checked(loose), [], show).problems).toEqual([]);
});
