import { describe, expect, it } from "vitest";

import { compilingText, countText, factorText, speedText, timeText, unitText } from "./format";

describe("simulated time", () => {
  it("is written in the unit of the document below a second, in seconds above", () => {
    expect(timeText(0, "ms", 1)).toBe("0 ms");
    expect(timeText(850, "ms", 1)).toBe("850 ms");
    expect(timeText(1000, "ms", 1)).toBe("1.000 s");
    expect(timeText(12_345, "ms", 1)).toBe("12.345 s");
    expect(timeText(12_345_678, "ms", 1)).toBe("12\u2009345.678 s");
    expect(timeText(40, "us", 10)).toBe("40 µs");
    expect(timeText(0.25, "s", 0.001)).toBe("0.250 s");
    expect(timeText(-200, "ms", 1)).toBe("\u2212200 ms");
  });

  it("has the decimals of the time step", () => {
    expect(timeText(0.5, "ms", 0.5)).toBe("0.5 ms");
    expect(timeText(2.5, "min", 0.25)).toBe("2.50 min");
    expect(timeText(1 / 3, "ms", 1 / 3)).toBe("0.333 ms");
  });

  it("is a plain number in the model's own units", () => {
    expect(timeText(12_000, "abstract", 1)).toBe("12\u2009000");
    expect(timeText(7, "1 = 64 ms", 1)).toBe("7");
    expect(unitText("abstract")).toBe("");
    expect(unitText("us")).toBe("µs");
  });
});

it("the ratio to real time has three digits", () => {
  expect([0, 0.0213, 1, 9.999, 12.34, 340.2, 9999, 12_345].map(factorText)).toEqual([
    "×0.00",
    "×0.02",
    "×1.00",
    "×10.0",
    "×12.3",
    "×340",
    "×9999",
    "×12k",
  ]);
  expect(factorText(Number.NaN)).toBe("×–");
});

it("speeds and counts are short", () => {
  expect([0.01, 1, 10, 0.12345, null].map(speedText)).toEqual(["0.01×", "1×", "10×", "0.123×", "max"]);
  expect(countText(1_234_567)).toBe("1\u2009234\u2009567");
});

it("a compilation shows its time, and the expected one while it may still hold", () => {
  const text = (elapsed: number, expected: number | null) =>
    compilingText({ phase: "compiling", elapsed, expected });
  expect(text(2.7, 5.4)).toBe("2 s of about 5 s");
  expect(text(0.2, null)).toBe("0 s");
  expect(text(0.2, 0.4)).toBe("0 s");
  expect(text(11, 5)).toBe("11 s");
});
