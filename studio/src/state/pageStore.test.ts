import { expect, it } from "vitest";

import { fakeDocument, fakeElement } from "../architecture/fakes";
import { useStudio } from "../server/store";
import { useRecordChoice } from "../transport/recordChoice";
import { useNext } from "../actions/run";
import { pageStore } from "./pageStore";

const document = fakeDocument([fakeElement("u")]);
const open = (session: number, version: number) =>
  useStudio.getState().take({ type: "opened", session, version, document });

it("an edit and a document that is sent again keep what the page holds; another session empties it", () => {
  const [one, other] = [pageStore(() => ({ at: 0, text: "" })), pageStore(() => ({ open: false }))];
  open(1, 1);
  one.setState({ at: 3 });
  other.setState({ open: true });
  open(1, 2);
  expect([one.getState(), other.getState()]).toEqual([{ at: 3, text: "" }, { open: true }]);
  open(2, 2);
  expect([one.getState(), other.getState()]).toEqual([{ at: 0, text: "" }, { open: false }]);
});

it("a seed that waits for a reset and a choice of ports to record are not those of the next document", () => {
  open(3, 1);
  useNext.setState({ seed: 7, steps: 10 });
  useRecordChoice.setState({ ports: [], every: 10 });
  open(4, 1);
  expect(useNext.getState()).toEqual({ seed: null, steps: 1 });
  expect(useRecordChoice.getState()).toEqual({ ports: null, every: null });
});
