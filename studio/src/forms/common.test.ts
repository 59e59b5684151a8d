import { expect, test } from "vitest";

import { fakeElement, fakeForm, fakeKind, kindsOf } from "../architecture/fakes";
import { common } from "./common";

const tau = fakeForm("tau", "number", { unit: "ms" });
const axes = fakeForm("axes", "axes");
const kinds = kindsOf(
  fakeKind("Field", "elements", { parameters: [axes, tau, fakeForm("noise", "number")] }),
  fakeKind("Node", "elements", { parameters: [tau, fakeForm("noise", "flag")] }),
);
const u = fakeElement("u", "Field", { values: { axes: ["x"], tau: 20, noise: 0 } });

test("elements of one kind share all parameters, and those with different values are marked", () => {
  const v = { ...u, id: "v", values: { ...u.values, tau: 30 } };
  expect(common([u, v], kinds).map(({ form, value, differs }) => [form.name, value, differs])).toEqual([
    ["axes", ["x"], false],
    ["tau", 20, true],
    ["noise", 0, false],
  ]);
});

test("elements of different kinds share the parameters of the same name and form", () => {
  const node = fakeElement("n", "Node", { values: { tau: 20, noise: false } });
  expect(common([u, node], kinds).map(({ form }) => form.name)).toEqual(["tau"]);
});
