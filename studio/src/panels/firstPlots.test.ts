import { expect, test } from "vitest";

import type { DocumentView } from "../protocol";
import { listedPlots } from "./firstPlots";

const elements = [
  { id: "1", path: "u", outputs: ["activation", "output"], inputs: ["input"] },
  { id: "2", path: "k", outputs: ["output"], inputs: ["input"] },
];

const document = (plots: unknown) => ({ elements, layout: { plots } }) as unknown as DocumentView;

test("the plots of a layout are listed in their order, and invalid entries are skipped", () => {
  const plots = [
    { element: "2", port: "output" },
    null,
    3,
    { element: "9", port: "output" },
    { element: "1", port: "colour" },
    { element: "1" },
    { element: "1", port: "activation" },
  ];
  expect(listedPlots(document(plots)).map(({ element, port }) => [element.path, port])).toEqual([
    ["k", "output"],
    ["u", "activation"],
  ]);
  expect(listedPlots(document(undefined))).toEqual([]);
  expect(listedPlots(document("nonsense"))).toEqual([]);
});
