// A pinned parameter as a control takes it: in the panel of sliders, and in the box of its element.

import { chosen } from "../model/sliderRange";
import { type ControlLook, useDocumentParameterLook, useLook } from "../state/controlLook";
import { driver } from "../model/leaf";
import { type Setting, useSetting } from "./setting";
import type { DocumentParameterView, ElementView, PinView } from "../protocol";
import { useStudio } from "../server/store";
import { valueAt } from "../model/values";

type PinnedNumber = {
  element: ElementView | undefined;
  // The document parameter that is pinned, or that drives the pinned one.
  shared: DocumentParameterView | undefined;
  path: string;
  setting: Setting<number | null>;
  // With the chosen range; undefined where the document has no such number any more.
  look: ControlLook | undefined;
  rangeKey: string;
};

export function usePin({ element: id, parameter, lower, upper }: PinView): PinnedNumber {
  const element = useStudio((state) => state.elements.get(id));
  const shared = useStudio((state) =>
    id === ""
      ? state.document?.parameters.find((k) => k.name === parameter)
      : driver(state.document, id, parameter),
  );
  const stored = shared === undefined ? valueAt(element?.values, parameter) : shared.value;
  const ownLook = useLook(id, parameter, stored);
  const parameterLook = useDocumentParameterLook(shared);
  const look = id !== "" ? ownLook : shared === undefined ? undefined : parameterLook;
  const value = typeof stored === "number" ? stored : null;
  const setting = useSetting<number | null>(
    shared === undefined ? id : "",
    shared?.name ?? parameter,
    value,
    look?.cost ?? "live",
  );
  const isThere = look !== undefined && (value !== null || look.optional);
  return {
    element,
    shared,
    path: id === "" ? parameter : `${element?.path ?? id}.${parameter}`,
    setting,
    look: isThere ? { ...look, range: chosen(look.range, lower, upper) } : undefined,
    rangeKey: `${id} ${parameter} ${lower ?? ""} ${upper ?? ""}`,
  };
}
