// The context of the forms of a card: where a change goes, and which names the model and the experiment have.

import { useMemo } from "react";

import { axesOf, type Kinds, leavesOf } from "../model/leaf";
import type { Names, Place } from "../state/place";
import type { AxisView, DocumentView, ElementView, ParameterForm } from "../protocol";
import { useStudio } from "../server/store";
import { type Values, valueAt as inside } from "../model/values";
import { edit } from "./actions";
import { type Data, type Group, partsOf, put, setAt } from "./draft";

const NO_DATA: Data = {};

export function useData(): Data {
  return useStudio((state) => state.experiment?.data) ?? NO_DATA;
}

// Names that a text may be, for a document and an experiment.
export function namesOf(of: Names, document: DocumentView | null, kinds: Kinds, data: Data): string[] {
  const elements = document?.elements ?? [];
  switch (of) {
    case "":
      return [];
    case "element":
      return elements.map(({ path }) => path);
    case "port":
      return elements.flatMap(({ path, outputs }) => outputs.map((port) => `${path}.${port}`));
    case "parameter":
      return parametersOf(elements, kinds);
    case "event":
      return partsOf(data, "conditions").map(({ key }) => key);
  }
}

// Numbers that a trial may set, by their paths.
export function parametersOf(elements: ElementView[], kinds: Kinds): string[] {
  return elements.flatMap(({ kind, path, values }) =>
    leavesOf(kinds, kind, { ...values, kind }, `${path}.`).map((leaf) => leaf.path),
  );
}

// The value that a parameter has in the document; undefined without such a number.
export function valueAt(elements: ElementView[], path: string): unknown {
  const element = elements.find((e) => path.startsWith(`${e.path}.`));
  return element && inside(element.values, path.slice(element.path.length + 1));
}

// The axes of the first element that a card names.
function axesNamed(values: Values, forms: ParameterForm[], document: DocumentView | null, kinds: Kinds) {
  for (const { name, names } of forms) {
    const text = values[name];
    if ((names === "port" || names === "element") && typeof text === "string") {
      const element = document?.elements.find(({ path }) => text === path || text.startsWith(`${path}.`));
      if (element !== undefined) {
        return axesOf(element, kinds.get(element.kind), document?.axes ?? []).axes;
      }
    }
  }
  return [] as AxisView[];
}

// The forms of the experiment itself, or of one of its parts.
export function useCardPlace(forms: ParameterForm[], values: Values, group?: Group, key = ""): Place {
  const document = useStudio((state) => state.document);
  const kinds = useStudio((state) => state.kinds);
  const data = useData();
  return useMemo(
    () => ({
      element: "",
      axes: axesNamed(values, forms, document, kinds),
      own: false,
      timeUnit: document?.time_unit ?? "",
      send: (path, value) =>
        edit((now) => {
          if (group === undefined) {
            return setAt(now, forms, path, value);
          }
          const present = partsOf(now, group).find((part) => part.key === key)?.values ?? values;
          return put(now, group, key, setAt(present, forms, path.slice(key.length + 1), value));
        }),
      names: (of) => namesOf(of, document, kinds, data).filter((name) => name !== key),
    }),
    [group, key, values, forms, document, kinds, data],
  );
}

// The values of the forms, those that are not stated as their defaults.
export const withDefaults = (values: Values, forms: ParameterForm[]): Values =>
  Object.fromEntries(forms.map((form) => [form.name, values[form.name] ?? form.default]));
