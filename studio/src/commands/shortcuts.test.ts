import { readFileSync } from "node:fs";
import { join } from "node:path";

import { describe, expect, it } from "vitest";

import { isPressed, keysText } from "../model/keys";
import { SHORTCUTS } from "./shortcuts";

const press = (key: string, held: string = "") => ({
  key,
  ctrlKey: held.includes("c"),
  metaKey: held.includes("m"),
  shiftKey: held.includes("s"),
  altKey: held.includes("a"),
});

describe("a key press", () => {
  it("differs from other keys", () => {
    expect(isPressed("Ctrl+Z", press("z", "c"))).toBe(true);
    expect(isPressed("Ctrl+Z", press("z", "m"))).toBe(true);
    expect(isPressed("Ctrl+Z", press("Z", "cs"))).toBe(false);
    expect(isPressed("Ctrl+Z", press("z"))).toBe(false);
    expect(isPressed("Ctrl+Z", press("z", "ca"))).toBe(false);
    expect(isPressed("Ctrl+Shift+Z", press("Z", "cs"))).toBe(true);
    expect(isPressed("Space", press(" "))).toBe(true);
    expect(isPressed("Space", press(" ", "s"))).toBe(false);
    expect(isPressed("Shift+R", press("R", "s"))).toBe(true);
    expect(isPressed("Shift+R", press("r"))).toBe(false);
  });

  it("of a sign may include Shift", () => {
    expect(isPressed("?", press("?", "s"))).toBe(true);
    expect(isPressed(".", press("."))).toBe(true);
    expect(isPressed(".", press(".", "s"))).toBe(true);
    expect(isPressed(".", press(".", "c"))).toBe(false);
  });

  it("triggers at most one shortcut", () => {
    const all = SHORTCUTS.flatMap((s) => s.keys);
    expect(new Set(all).size).toBe(all.length);
  });
});

it("keys have the names that the operating system shows", () => {
  expect(keysText("Ctrl+Shift+Z", false)).toBe("Ctrl+Shift+Z");
  expect(keysText("Ctrl+Shift+Z", true)).toBe("⌘⇧Z");
  expect(["ArrowLeft", "ArrowRight", "Home"].map((keys) => keysText(keys))).toEqual(["←", "→", "Home"]);
});

it("the page for users of cedar names only keys that the studio has", () => {
  const page = readFileSync(join(import.meta.dirname, "../../../docs/from-cedar.md"), "utf8");
  const rows = page.split("\n").filter((line) => line.startsWith("|"));
  // the left column has the keys of cedar, which are those of the studio where the right one states so
  const ours = rows
    .map((line) => line.split("|"))
    .map(([, left, right = ""]) => {
      return right.includes("the same") ? `${left} ${right}` : right;
    });
  const named =
    ours.join("\n").match(/(?:(?:Ctrl|Shift)\+)+[A-Z]\b|\bF\d+\b|\bSpace\b|\bDelete\b|`[^\w\s]`/g) ?? [];
  // the canvas itself handles Ctrl+F
  const known = new Set([...SHORTCUTS.flatMap(({ keys }) => keys), "Ctrl+F"]);
  expect(named.length).toBeGreaterThan(15);
  expect(named.map((key) => key.replaceAll("`", "")).filter((key) => !known.has(key))).toEqual([]);
});
