// An array: its shape and range, read only.

import { numberText } from "../numbers/number";
import { ParameterRow } from "../parameters/ParameterRow";
import type { FormProps } from "./props";

export function ArrayForm({ form, path, value }: FormProps) {
  return (
    <ParameterRow form={form} path={path} value={value} inline onReset={() => undefined}>
      <span className="dim one-line grow" title={arrayText(value)}>
        {arrayText(value)}
      </span>
    </ParameterRow>
  );
}

// Shape and range if the server states them, else the name of the stored array.
export function arrayText(value: unknown): string {
  if (typeof value !== "object" || value === null) {
    return "none";
  }
  const { shape, min, max, array, digest } = value as Record<string, unknown>;
  const size = Array.isArray(shape) ? `${shape.join(" × ")} numbers` : "";
  const range =
    typeof min === "number" && typeof max === "number" ? `${numberText(min)} to ${numberText(max)}` : "";
  const known = [size, range].filter((text) => text !== "").join(", ");
  return known || String(array ?? digest ?? "numbers");
}
