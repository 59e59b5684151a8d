import { expect, test } from "vitest";

import { fakeDocument } from "../architecture/fakes";
import { useStudio } from "./store";

test("new results of the check replace those of the document, and outdated results are dropped", () => {
  const { take } = useStudio.getState();
  take({ type: "opened", session: 1, version: 3, document: fakeDocument([], []) });
  take({ type: "checked", version: 3, problems: [{ what: "never on", element: "u", severity: "warning" }] });
  expect(useStudio.getState().document?.problems.map((p) => p.what)).toEqual(["never on"]);
  take({ type: "checked", version: 2, problems: [] });
  expect(useStudio.getState().document?.problems).toHaveLength(1);
});
