import { describe, expect, it } from "vitest";

import type { Kind } from "../protocol";
import {
  belowRoot,
  isWhole,
  joined,
  lastPart,
  nameProblem,
  parent,
  rootName,
  opening,
  sortOf,
  steps,
  withEnding,
} from "./paths";

describe("paths", () => {
  it("lead to the parent folder and to entries", () => {
    expect(parent("a/b/c.json")).toBe("a/b");
    expect(parent("c.json")).toBe("");
    expect(lastPart("a/b/c.json")).toBe("c.json");
    expect(joined("", "c.json")).toBe("c.json");
    expect(joined("a/b", "c.json")).toBe("a/b/c.json");
  });

  it("list the folders that lead to them", () => {
    expect(steps("")).toEqual([]);
    expect(steps("a/b")).toEqual([
      { name: "a", path: "a" },
      { name: "b", path: "a/b" },
    ]);
  });

  it("begin at a root with a short name", () => {
    expect(rootName("/data/me/models")).toBe("models");
    expect(rootName("C:\\models\\")).toBe("models");
    expect(rootName("/")).toBe("/");
    expect(belowRoot("/data/me", "/data/me/a/b.json")).toBe("a/b.json");
    expect(belowRoot("C:\\models", "C:\\models\\a\\b.json")).toBe("a/b.json");
    expect(belowRoot("/data/me", "/data/mean.json")).toBe("/data/mean.json");
    expect(belowRoot("/data/me", "dropped.json")).toBe("dropped.json");
    expect(["/a.json", "C:\\a.json", "a.json", "a/b.json", ""].map(isWhole)).toEqual([
      true,
      true,
      false,
      false,
      false,
    ]);
  });
});

describe("names of documents", () => {
  it("get the ending .json once", () => {
    expect(withEnding(" selection ")).toBe("selection.json");
    expect(withEnding("selection.JSON")).toBe("selection.JSON");
    expect(withEnding("a.b")).toBe("a.b.json");
    expect(withEnding("a.deodar")).toBe("a.deodar");
  });

  it("are refused if they are empty, hidden or contain a folder", () => {
    expect(nameProblem("selection")).toBe("");
    expect(nameProblem("my model 2.json")).toBe("");
    for (const name of ["", "  ", ".json", "../up", "a/b", "a\\b", ".hidden", "..", "C:x", "a\nb"]) {
      expect(nameProblem(name), name).not.toBe("");
    }
  });
});

it("files are sorted by type and name", () => {
  expect(sortOf({ name: "a.json", type: "" })).toBe("document");
  expect(sortOf({ name: "a", type: "application/json" })).toBe("document");
  expect(sortOf({ name: "launcher.m", type: "text/x-matlab" })).toBe("document");
  expect(sortOf({ name: "a.deodar", type: "" })).toBe("package");
  expect(sortOf({ name: "a.txt", type: "text/plain" })).toBe("other");
});

it("finds the kind of world that opens a file, by the ending of its name", () => {
  const kinds = [
    { name: "Arena", opens: [".json"] },
    { name: "Picture", opens: [".png", ".jpg"] },
  ] as Kind[];
  expect(opening(kinds, "a.JPG")?.name).toBe("Picture");
  expect(opening(kinds, "a.txt")).toBeUndefined();
  const both = ["aedat", "mp4"].map((own) => ({ name: own, opens: [`.${own}`, ".mp4"] })) as Kind[];
  expect(opening(both, "a.mp4")?.name).toBe("mp4");
  expect(opening(both, "a.aedat")?.name).toBe("aedat");
});
