import { expect, test } from "vitest";
import type { RunClock } from "../protocol";
import { fakeDocument } from "../architecture/fakes";
import { labelOf } from "../architecture/label";
import { problemOf, warningOf } from "./problem";

test("the failure of the run comes before the problems of the document", () => {
  const document = fakeDocument([], [], { problems: [{ what: "axes", fix: "Project", element: "u" }] });
  const clock = { failure: [{ what: "not finite", element: "u" }] } as RunClock;
  expect(problemOf("u", { document, clock: null })).toBe("axes\nProject");
  expect(problemOf("u", { document, clock })).toBe("not finite");
  expect(problemOf("v", { document, clock })).toBe("");
});

test("a warning is not a problem of its element", () => {
  const document = fakeDocument([], [], {
    problems: [{ what: "never on", element: "u", severity: "warning" }],
  });
  expect(problemOf("u", { document, clock: null })).toBe("");
});

test("all warnings of an element are listed with their fixes, and problems are not among them", () => {
  const warning = { element: "u", severity: "warning" } as const;
  const document = fakeDocument([], [], {
    problems: [
      { what: "axes", element: "u" },
      { what: "never on", fix: "Longer", ...warning },
      { what: "too weak", fix: "", ...warning },
      { what: "beside", ...warning, element: "v" },
    ],
  });
  expect(warningOf("u", { document, clock: null })).toBe("never on\nLonger\n\ntoo weak");
  expect(warningOf("v", { document, clock: null })).toBe("beside");
  expect(warningOf("w", { document: null, clock: null })).toBe("");
});

test("the kind replaces a name that was made from a connection", () => {
  expect(labelOf("colour>Convolve", "Convolve", "Convolution")).toBe("Convolution");
  expect(labelOf("colour>Gain2", "Gain", "Gain")).toBe("Gain");
  expect(labelOf("strength", "Gain", "Gain")).toBe("strength");
  expect(labelOf("u -> v", "Gain", "Gain"), "a name that a person gave").toBe("u -> v");
});
