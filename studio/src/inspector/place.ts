// The context of the inspector's forms: the element, its axes, and the linked document parameters.

import { createContext, useContext } from "react";

import type { AxisView, DocumentParameterView } from "../protocol";
import { useStudio } from "../store";
import { driver } from "./leaf";

export type Place = {
  element: string;
  axes: AxisView[];
  // Whether the axes are a parameter of the element itself.
  own: boolean;
  timeUnit: string;
};

export const PlaceContext = createContext<Place>({ element: "", axes: [], own: false, timeUnit: "" });

export function usePlace(): Place {
  return useContext(PlaceContext);
}

export function useDriver(path: string): DocumentParameterView | undefined {
  const { element } = usePlace();
  return useStudio((state) => driver(state.document, element, path));
}
