import { expect, test } from "vitest";

import { nameParts } from "./nameParts";

const broken = (name: string) =>
  nameParts(name)
    .map(({ text, hyphen }) => (hyphen ? `${text}-` : text))
    .join("|");

test("a name breaks at its parts and between words", () => {
  expect(broken("wm_c1")).toBe("wm_|c1");
  expect(broken("change of mode")).toBe("change |of |mode");
  expect(broken("spatialAttention")).toBe("spatial|Atten-|tion");
  expect(broken("left.task > done")).toBe("left.|task |> |done");
});

test("a long word breaks between two consonants, with a hyphen, and a short one nowhere", () => {
  expect(broken("satisfaction")).toBe("satis-|fac-|tion");
  expect(broken("precondition")).toBe("precon-|dition");
  expect(broken("selected")).toBe("selected");
  expect(broken("color satisfaction")).toBe("color |satis-|fac-|tion");
});

test("the parts of a name are the name", () => {
  for (const name of ["Condition of satisfaction", "a_b-c", "", "__x", "colour_searchSpace2"]) {
    expect(
      nameParts(name)
        .map(({ text }) => text)
        .join(""),
    ).toBe(name);
  }
});
