// Parameters by their path, at any depth: the target of a path such as kernel.0.sigma, and which of them are
// numbers that can be driven.

import type {
  AxisView,
  DocumentView,
  ElementView,
  Kind,
  DocumentParameterView,
  ParameterForm,
} from "../protocol";
import type { Values } from "./values";
import type { Standing } from "./sliderRange";

export type Kinds = Map<string, Kind>;

export type Leaf = { path: string; form: ParameterForm };

const NUMBERS: ParameterForm["form"][] = ["number", "per_axis", "numbers"];

// Numbers that change while the model runs can be linked to a document parameter.
export function linkable(form: ParameterForm): boolean {
  return NUMBERS.includes(form.form) && form.cost !== "recompile";
}

// How the parameter at a path is declared; undefined without a parameter there.
export function formAt(kinds: Kinds, kind: string, values: unknown, path: string): ParameterForm | undefined {
  const [head = "", ...rest] = path.split(".");
  const form = kinds.get(kind)?.parameters.find((p) => p.name === head);
  if (form === undefined || !isValues(values)) {
    return undefined;
  }
  const value = values[head];
  const below = (part: unknown, steps: string[]) =>
    isValues(part) ? formAt(kinds, String(part["kind"]), part, steps.join(".")) : undefined;
  const [next, ...further] = rest;
  if (next === undefined) {
    return form;
  }
  switch (form.form) {
    case "part":
      return below(value, rest);
    case "parts":
      return below(Array.isArray(value) ? (value as unknown[])[Number(next)] : undefined, further);
    case "per_axis":
    case "numbers":
      return further.length === 0 && isHolder(value) && next in value ? form : undefined;
    default:
      return undefined;
  }
}

// Every number inside that can be driven, in the order of the declarations.
export function leavesOf(kinds: Kinds, kind: string, values: unknown, prefix = ""): Leaf[] {
  if (!isValues(values)) {
    return [];
  }
  return (kinds.get(kind)?.parameters ?? []).flatMap((form): Leaf[] => {
    const value = values[form.name];
    const path = prefix + form.name;
    if (form.form === "part") {
      return isValues(value) ? leavesOf(kinds, String(value["kind"]), value, `${path}.`) : [];
    }
    if (form.form === "parts") {
      const items = Array.isArray(value) ? (value as unknown[]) : [];
      return items.flatMap((item, i) =>
        isValues(item) ? leavesOf(kinds, String(item["kind"]), item, `${path}.${i}.`) : [],
      );
    }
    if (!linkable(form) || value === null || value === undefined) {
      return [];
    }
    return isHolder(value)
      ? Object.keys(value).map((key) => ({ path: `${path}.${key}`, form }))
      : [{ path, form }];
  });
}

// The document parameter that drives a parameter of an element.
export function driver(
  document: DocumentView | null,
  element: string,
  path: string,
): DocumentParameterView | undefined {
  return document?.parameters.find(({ links }) =>
    links.some((link) => link.element === element && link.parameter === path),
  );
}

// The axes of an element: its own parameter, or else those of its ports.
export function axesOf(
  element: ElementView,
  kind: Kind | undefined,
  axes: AxisView[],
): Omit<Standing, "path"> {
  const form = kind?.parameters.find((p) => p.form === "axes" || p.form === "axis");
  const keys = form !== undefined ? [element.values[form.name]].flat() : longest(Object.values(element.axes));
  return {
    axes: keys.flatMap((key) => axes.find((axis) => axis.key === key) ?? []),
    own: form !== undefined,
  };
}

function longest(lists: string[][]): string[] {
  return lists.reduce((most, list) => (list.length > most.length ? list : most), []);
}

function isValues(value: unknown): value is Values {
  return isHolder(value) && !Array.isArray(value);
}

function isHolder(value: unknown): value is object {
  return typeof value === "object" && value !== null;
}
