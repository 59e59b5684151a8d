// A kind or a template that is dragged from the list of elements to the canvas.

import type { Values } from "../model/values";
import type { ListEntry } from "../model/entries";

const TYPE = { kind: "application/x-deodar-kind", template: "application/x-deodar-template" };

// `values` are those of a new element, `called` is its name.
export type Carried = { what: keyof typeof TYPE; name: string; values?: Values; called?: string };

// What an entry of the list carries; null: it is not dragged.
export function carriedBy({ kind, template, why, values, called }: ListEntry): Carried | null {
  if (why !== undefined) {
    return null;
  }
  if (template !== undefined) {
    return { what: "template", name: template.name };
  }
  return kind === undefined ? null : { what: "kind", name: kind.name, values: values?.(), called };
}

export function carry(transfer: DataTransfer, { what, ...rest }: Carried): void {
  transfer.setData(TYPE[what], JSON.stringify(rest));
  transfer.effectAllowed = "copy";
}

export const isCarried = ({ types }: DataTransfer): boolean =>
  types.includes(TYPE.kind) || types.includes(TYPE.template);

// What is dropped.
export function carried(transfer: DataTransfer): Carried | null {
  const what = transfer.types.includes(TYPE.template) ? "template" : "kind";
  const text = transfer.getData(TYPE[what]);
  return text === "" ? null : { what, ...(JSON.parse(text) as Omit<Carried, "what">) };
}
