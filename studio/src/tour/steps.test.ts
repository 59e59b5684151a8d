import { beforeEach, expect, test } from "vitest";

import type { DocumentView, RunClock } from "../protocol";
import { type Studio, useStudio } from "../server/store";
import { central, STEPS } from "./steps";
import { endTour, follow, goTo, useTour } from "./tour";

const ends = (source: string, target: string) => ({ source, source_port: "", target, target_port: "" });

function studio(document: Partial<DocumentView>, clock: Partial<RunClock> = {}): Studio {
  return { ...useStudio.getState(), document: document as DocumentView, clock: clock as RunClock };
}

const document = {
  elements: [{ id: "a" }, { id: "u" }, { id: "b" }],
  connections: [ends("a", "u"), ends("b", "u")],
  undo: 3,
  file: "",
  unsaved: false,
} as unknown as DocumentView;

const still = { running: false, pushing: "", timeline: null } as unknown as RunClock;
const begun = studio(document, still);

beforeEach(endTour);

test("the central element is the one that most connections lead to", () => {
  expect(central(begun)?.id).toBe("u");
  expect(central(studio({ ...document, connections: [] }))?.id).toBe("a");
});

test.each<[string, Studio]>([
  ["Run the model", studio(document, { ...still, running: true })],
  ["Select an element", { ...begun, selected: ["u"] }],
  ["Find an instability", studio({ ...document, undo: 4 }, still)],
  ["Undo", studio({ ...document, undo: 2 }, still)],
  ["Add input by hand", studio(document, { ...still, pushing: "u" })],
  ["Go back in time", studio(document, { ...still, timeline: { time: 1 } as RunClock["timeline"] })],
  ["Add an element", studio({ ...document, elements: [...document.elements, ...document.elements] }, still)],
  ["Connect it", studio({ ...document, connections: [...document.connections, ...document.connections] })],
  ["Save", studio({ ...document, file: "mine.json" }, still)],
])("the step %s is done by its action, and not before", (title, after) => {
  const step = STEPS.find((one) => one.title === title);
  expect(step?.done(begun, begun)).toBe(false);
  expect(step?.done(after, begun)).toBe(true);
});

test("every step of the tour is among those tested", () => {
  expect(STEPS).toHaveLength(9);
});

test("the tour notices that a step was done, and ends with its document", () => {
  useStudio.setState({ document, clock: still, session: 1 });
  goTo(0);
  follow({ ...useStudio.getState(), clock: { ...still, running: true } });
  expect(useTour.getState()).toMatchObject({ step: 0, done: true });
  goTo(1);
  expect(useTour.getState()).toMatchObject({ step: 1, done: false });
  follow({ ...useStudio.getState(), session: 2 });
  expect(useTour.getState().step).toBe(null);
});

test("the document of the tour may arrive after its beginning", () => {
  useStudio.setState({ document, clock: still, session: 1 });
  goTo(0);
  follow({ ...useStudio.getState(), session: 2 });
  expect(useTour.getState()).toMatchObject({ step: 0, before: { session: 2 } });
});
