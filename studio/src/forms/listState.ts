// No list, an empty list, and one with parts, where the words of a parameter distinguish them.

import type { ParameterForm } from "../protocol";

export type ListState = "absent" | "empty" | "listed";

export function listState(value: unknown): ListState {
  return Array.isArray(value) ? (value.length === 0 ? "empty" : "listed") : "absent";
}

// What may be chosen besides adding parts; empty where the parameter has no words for it.
export function listChoices(form: ParameterForm, state: ListState): { value: ListState; label: string }[] {
  const { if_none = "", if_empty = "" } = form;
  if (!form.optional || if_none === "" || if_empty === "") {
    return [];
  }
  return [
    { value: "absent", label: if_none },
    { value: "empty", label: if_empty },
    ...(state === "listed" ? [{ value: state, label: "as listed" }] : []),
  ];
}
