// Numbers as they are shown, and as they are typed.

const DIGITS = 6;

// A short text for reading, rounded to six digits.
export function numberText(value: number): string {
  if (!Number.isFinite(value)) {
    return String(value);
  }
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e7 || size < 1e-4)) {
    return value
      .toExponential(DIGITS - 1)
      .replace(/\.?0+e/, "e")
      .replace("e+", "e");
  }
  return String(Number(value.toPrecision(DIGITS)));
}

// The number that was typed, or null where it is none. A comma is read as a point, the true minus as a minus.
export function typedNumber(text: string): number | null {
  const plain = text.trim().replace(",", ".").replace("−", "-");
  const value = Number(plain);
  return plain === "" || !Number.isFinite(value) ? null : value;
}

export type Limits = { lower?: number; upper?: number; whole?: boolean; optional?: boolean };

// What is wrong with the text of a number, or null.
export function wrongWith(text: string, limits: Limits): string | null {
  const { lower = -Infinity, upper = Infinity, whole = false, optional = false } = limits;
  const number = typedNumber(text);
  const wanted = whole ? "needs a whole number" : "needs a number";
  if (text.trim() === "") {
    return optional ? null : wanted;
  }
  if (number === null || (whole && !Number.isInteger(number))) {
    return `${wanted}, not ${text.trim()}`;
  }
  return number < lower ? `must be at least ${lower}` : number > upper ? `must be at most ${upper}` : null;
}

// One press of an arrow key further: one in the second digit, or one whole; coarse is ten times as far.
export function arrowStep(value: number, direction: 1 | -1, coarse: boolean, limits: Limits): number {
  const { lower = -Infinity, upper = Infinity, whole = false } = limits;
  const fine = whole ? 1 : 10 ** (value === 0 ? -1 : Math.floor(Math.log10(Math.abs(value))) - 1);
  const next = Number((value + direction * (coarse ? 10 : 1) * fine).toPrecision(12));
  return Math.min(upper, Math.max(lower, next));
}
