// A value of any type, as it is typed: what JSON can read is that value, the rest is text.

import { typedNumber } from "../model/number";

export function typedValue(text: string): unknown {
  const trimmed = text.trim();
  const number = typedNumber(trimmed);
  if (number !== null) {
    return number;
  }
  try {
    return JSON.parse(trimmed) as unknown;
  } catch {
    return trimmed === "" ? null : trimmed;
  }
}

export function valueText(value: unknown): string {
  if (value === null || value === undefined) {
    return "";
  }
  return typeof value === "string" ? value : JSON.stringify(value);
}
