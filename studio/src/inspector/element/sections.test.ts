import { expect, test } from "vitest";
import { fakeForm } from "../../architecture/fakes";
import { sectionsOf } from "./sections";

test("parameters are listed by section, in the order of their declaration, without empty sections", () => {
  const found = sectionsOf([
    fakeForm("axes", "axes", { section: "axes" }),
    fakeForm("noise", "number", { section: "noise" }),
    fakeForm("factor", "number"),
    fakeForm("tau", "number", { section: "time course" }),
    fakeForm("rest", "number", { section: "time course" }),
  ]);
  expect(found.map(({ section, forms }) => [section, ...forms.map(({ name }) => name)])).toEqual([
    ["", "factor"],
    ["time course", "tau", "rest"],
    ["noise", "noise"],
    ["axes", "axes"],
  ]);
});
