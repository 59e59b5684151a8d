// The context of the inspector's forms: the element, its axes, and the linked document parameters.

import { createContext, useContext } from "react";

import type { Answer, AxisView, DocumentParameterView, ParameterForm } from "../protocol";
import { useStudio } from "../server/store";
import { driver } from "../model/leaf";

export type Place = {
  element: string;
  axes: AxisView[];
  // Whether the axes are a parameter of the element itself.
  own: boolean;
  timeUnit: string;
  // Sends a parameter that is not one of an element of the document; without pins and links.
  send?: (path: string, value: unknown, gesture: number) => Promise<Answer>;
  // The names that a text may be, where its declaration says what it names.
  names?: (of: Names) => string[];
};

export type Names = NonNullable<ParameterForm["names"]>;

export const PlaceContext = createContext<Place>({ element: "", axes: [], own: false, timeUnit: "" });

export function usePlace(): Place {
  return useContext(PlaceContext);
}

export function useDriver(path: string): DocumentParameterView | undefined {
  const { element } = usePlace();
  return useStudio((state) => driver(state.document, element, path));
}

const NO_AXES: AxisView[] = [];

export function useAxes(): { axes: AxisView[]; timeUnit: string } {
  const axes = useStudio((state) => state.document?.axes) ?? NO_AXES;
  return { axes, timeUnit: useStudio((state) => state.document?.time_unit ?? "") };
}
