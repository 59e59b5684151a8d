import { expect, test } from "vitest";
import { fakeConnections, fakeDocument, fakeElement, fakeLayout } from "./fakes";
import { selector } from "./structure";

test("changed values leave the structure the same object", () => {
  const select = selector();
  const document = fakeDocument([fakeElement("u"), fakeElement("v")], fakeConnections("u v"));
  const first = select({ document });
  const elements = document.elements.map((e) => ({ ...e, values: { tau: 3 } }));
  expect(select({ document: { ...document, unsaved: true, elements } })).toBe(first);
});

test("every other change makes a new structure", () => {
  const select = selector();
  const document = fakeDocument([fakeElement("u")]);
  const first = select({ document });
  expect(select({ document: { ...document, layout: fakeLayout({ folded: [] }) } })).not.toBe(first);
  const second = select({ document });
  expect(select({ document: { ...document, elements: [fakeElement("w")] } })).not.toBe(second);
  expect(select({ document: null })).toBeNull();
});
