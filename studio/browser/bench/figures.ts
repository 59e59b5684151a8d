/** The figures that benchmarks/studio.py prints, each beside its target. */
import { loadavg } from "node:os";

export function show(name: string, value: number, unit: string, target = "none"): void {
  console.log(`${name.padEnd(62)} ${value.toFixed(2).padStart(9)} ${unit.padEnd(8)} (target ${target})`);
}

/** The load of the machine; figures of a busy machine are larger. */
export function showLoad(): void {
  show("load average of the machine in the last minute", loadavg()[0] ?? NaN, "", "none");
}

/** The quantile of values: this share of them is smaller. */
export function quantile(values: number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN;
}

export const median = (values: number[]): number => quantile(values, 0.5);
