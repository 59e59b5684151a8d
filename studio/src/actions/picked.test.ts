import { expect, test } from "vitest";
import { fakeDocument } from "../architecture/fakes";
import { useStudio } from "../server/store";
import { pickWire, usePicked } from "./picked";

const open = (session: number) =>
  useStudio.getState().take({ type: "opened", session, version: 1, document: fakeDocument([]) });

test("another document has no wires, groups or targets that were picked in the one before", () => {
  open(1);
  pickWire("a output b input", false);
  usePicked.setState({ groups: ["g"], over: "a output b input", into: "g" });
  open(2);
  expect(usePicked.getState()).toEqual({ wires: [], groups: [], over: null, into: null });
});

test("a picked wire stays picked while its document is sent again", () => {
  open(3);
  pickWire("a output b input", false);
  open(3);
  expect(usePicked.getState().wires).toEqual(["a output b input"]);
});
