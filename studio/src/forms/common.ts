// The parameters that several elements share.

import type { ElementView, ParameterForm } from "../protocol";
import type { Kinds } from "../model/leaf";

export type Common = { form: ParameterForm; value: unknown; differs: boolean };

// Parameters of the same name, form and unit in all elements, with the value of the first.
export function common(elements: ElementView[], kinds: Kinds): Common[] {
  const [first, ...others] = elements;
  const forms = kinds.get(first?.kind ?? "")?.parameters ?? [];
  return forms
    .filter((form) => form.form !== "array" && others.every(({ kind }) => has(kinds, kind, form)))
    .map((form) => {
      const value = first?.values[form.name] ?? null;
      const text = JSON.stringify(value);
      const differs = others.some(({ values }) => JSON.stringify(values[form.name] ?? null) !== text);
      return { form, value, differs };
    });
}

function has(kinds: Kinds, kind: string, { name, form, unit }: ParameterForm): boolean {
  return (kinds.get(kind)?.parameters ?? []).some(
    (other) => other.name === name && other.form === form && other.unit === unit,
  );
}
