// A whole number.

import { NumberRow } from "./NumberRow";
import type { FormProps } from "./props";

export function IntegerForm({ form, path, value }: FormProps) {
  return <NumberRow form={form} path={path} value={typeof value === "number" ? value : null} />;
}
