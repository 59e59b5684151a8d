import { expect, test } from "vitest";
import type { Clock } from "../protocol";
import { fakeDocument } from "./fakes";
import { labelOf } from "./label";
import { troubleOf } from "./trouble";

test("the failure of the run comes before the problems of the document", () => {
  const document = fakeDocument([], [], { problems: [{ what: "axes", fix: "Project", element: "u" }] });
  const clock = { failure: [{ what: "not finite", element: "u" }] } as Clock;
  expect(troubleOf("u", { document, clock: null })).toBe("axes\nProject");
  expect(troubleOf("u", { document, clock })).toBe("not finite");
  expect(troubleOf("v", { document, clock })).toBe("");
});

test("a warning marks no element as broken", () => {
  const document = fakeDocument([], [], { problems: [{ what: "never on", element: "u", severity: "warning" }] });
  expect(troubleOf("u", { document, clock: null })).toBe("");
});

test("a name made from a connection gives way to the kind", () => {
  expect(labelOf("colour>Convolve", "Convolve", "Convolution")).toBe("Convolution");
  expect(labelOf("colour>Gain2", "Gain", "Gain")).toBe("Gain");
  expect(labelOf("strength", "Gain", "Gain")).toBe("strength");
  expect(labelOf("u -> v", "Gain", "Gain"), "a name that somebody gave").toBe("u -> v");
});
