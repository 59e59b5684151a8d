// How a number is shown away from its own form: in a pinned row, as a document parameter.

import { useMemo } from "react";

import type { AxisView, ElementView, DocumentParameterView, ParameterForm } from "../protocol";
import { useStudio } from "../server/store";
import { axesOf, formAt, type Kinds } from "../model/leaf";
import { symbolOf } from "../model/part";
import { axesAt, type SliderRange, sliderRange } from "../model/sliderRange";
import { unitText } from "../model/unit";
import { useAxes } from "./place";

export type ControlLook = {
  range: SliderRange;
  unit: string;
  symbol: string;
  cost: ParameterForm["cost"];
  meaning: string;
  optional: boolean;
};

type Surroundings = { kinds: Kinds; axes: AxisView[]; timeUnit: string };

const UNDECLARED: ParameterForm = {
  name: "",
  form: "number",
  cost: "live",
  meaning: "",
  description: "",
  symbol: "",
  unit: "",
  lower: null,
  upper: null,
  default: null,
  optional: false,
  choices: [],
  of: [],
};

// Undefined without a number at that path.
export function lookOf(
  { kinds, axes, timeUnit }: Surroundings,
  element: ElementView | undefined,
  path: string,
  value: unknown,
): ControlLook | undefined {
  const form = element && formAt(kinds, element.kind, element.values, path);
  if (element === undefined || form === undefined) {
    return undefined;
  }
  const standing = { path, ...axesOf(element, kinds.get(element.kind), axes) };
  return {
    range: sliderRange(form, value, standing),
    unit: unitText(form.unit, timeUnit, axesAt(standing.axes, form, path)),
    symbol: symbolOf(form),
    cost: form.cost,
    meaning: form.description || form.meaning,
    optional: form.optional,
  };
}

export function useLook(element: string, path: string, value: unknown): ControlLook | undefined {
  const found = useStudio((state) => state.elements.get(element));
  const kinds = useStudio((state) => state.kinds);
  const { axes, timeUnit } = useAxes();
  return useMemo(
    () => lookOf({ kinds, axes, timeUnit }, found, path, value),
    [kinds, axes, timeUnit, found, path, value],
  );
}

// A document parameter has the range and the unit of the first parameter that it drives.
export function useDocumentParameterLook(documentParameter: DocumentParameterView | undefined): ControlLook {
  const first = documentParameter?.links[0];
  const driven = useLook(first?.element ?? "", first?.parameter ?? "", documentParameter?.value ?? null);
  const range = sliderRange(UNDECLARED, documentParameter?.value ?? null, {
    path: "",
    axes: [],
    own: false,
  });
  return { ...(driven ?? { range, unit: "", symbol: "", cost: "live", meaning: "" }), optional: false };
}
