import { expect, test } from "vitest";

import { type ListEntry, search } from "./entries";

const entry = (title: string, family: string, more: Partial<ListEntry> = {}): ListEntry => ({
  id: `${family} ${title}`,
  title,
  family,
  ...more,
});
const all = [
  entry("Field", "Fields", { words: "Field time scale resting level" }),
  entry("Memory trace", "Fields", { words: "MemoryTrace time scale" }),
  entry("Gaussian stimulus", "Sources"),
  entry("Gaussian", "Kernels", { why: "Select an element that has kernels" }),
  entry("Mexican hat", "Kernels", { why: "Select an element that has kernels" }),
];
const titles = (text: string) => search(text, all).found.map(({ title }) => title);
const best = (text: string) => search(text, all).best?.title;

test("without words every entry is listed, in the order of the families", () => {
  expect(titles("")).toEqual(all.map(({ title }) => title));
  expect(best("")).toBe("Field");
});

test("the beginning of a title beats a word inside it, and that beats other words", () => {
  expect(titles("t")[0]).toBe("Memory trace");
  expect(titles("scale")).toEqual(["Field", "Memory trace"]);
  expect(best("gau")).toBe("Gaussian stimulus");
});

test("a title that is the typed text comes before one that begins with it", () => {
  const [longer, same] = [entry("map2", "Go to"), entry("map", "Go to")];
  expect(search("map", [longer, same]).best?.title).toBe("map");
  expect(search("map ", [same, longer]).best?.title).toBe("map");
});

test("an entry that cannot be chosen is listed last, and is never the best", () => {
  expect(titles("gaussian").at(-1)).toBe("Gaussian");
  expect(best("mexican")).toBeUndefined();
});

test("every word has to occur, the family too", () => {
  expect(titles("hat ker")).toEqual(["Mexican hat"]);
  expect(titles("hat field")).toEqual([]);
});
