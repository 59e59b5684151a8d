// Numbers and times in few signs.

// A number for ticks at a distance of `step`.
export function tick(value: number, step: number): string {
  if (value !== 0 && (Math.abs(value) >= 1e6 || Math.abs(step) < 1e-4)) {
    return signed(value.toExponential(1));
  }
  return signed(value.toFixed(decimals(step)));
}

// The digits behind the point that a step needs: 2 for 0.25.
export function decimals(step: number): number {
  for (let digits = 0; digits < 6; digits++) {
    const shifted = Math.abs(step) * 10 ** digits;
    if (Math.abs(shifted - Math.round(shifted)) < 1e-6 * shifted) {
      return digits;
    }
  }
  return 6;
}

// A number in about three digits, for reading off a plot.
export function reading(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) {
    return signed(value.toExponential(2));
  }
  return signed(value.toFixed(size >= 100 ? 1 : size >= 10 ? 2 : 3));
}

// A number as a person would write it.
export function short(value: number): string {
  return signed(String(Number(value.toPrecision(4))));
}

function signed(text: string): string {
  return /[1-9]/.test(text) ? text.replace("-", "\u2212") : text.replace("-", "");
}

// Units of time in seconds; times in a unit of another name ("abstract") are written as they are.
export const SECONDS: Readonly<Record<string, number>> = { us: 1e-6, ms: 1e-3, s: 1, min: 60 };

// The factor from a unit of time to the one in which times are written, and that unit.
export function writtenTime(unit: string): { factor: number; unit: string } {
  const factor = SECONDS[unit];
  return factor === undefined ? { factor: 1, unit } : { factor, unit: "s" };
}

// A time to the thousandth up to 1000 s, to the tenth above.
export function timeText(time: number, unit: string): string {
  const { factor } = writtenTime(unit);
  const size = time * factor;
  const text = grouped(size, Math.abs(size) < 1000 ? 3 : 1);
  return unit in SECONDS ? `${text} s` : text;
}

// A number with thin spaces between thousands.
export function grouped(value: number, digits: number): string {
  const [whole = "", fraction] = Math.abs(value).toFixed(digits).split(".");
  const parted = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u2009") : whole;
  const minus = value < 0 ? "\u2212" : "";
  return `${minus}${parted}${fraction === undefined ? "" : `.${fraction}`}`;
}
