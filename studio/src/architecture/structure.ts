// The part of the document that the canvas is built from. It stays the same object while only values change,
// so that a slider that is dragged does not build the canvas again.

import { useState } from "react";
import type { ElementView } from "../protocol";
import { useStudio, type Studio } from "../server/store";
import type { Structure } from "./contract";

export function useStructure(): Structure | null {
  const [select] = useState(selector);
  return useStudio(select);
}

export function selector(): (state: Pick<Studio, "document">) => Structure | null {
  let last: Structure | null = null;
  return ({ document }) => {
    if (document === null || last === null || !alike(last, document)) {
      last = document === null ? null : pick(document);
    }
    return last;
  };
}

function pick({ elements, connections, groups, layout }: Structure): Structure {
  return { elements, connections, groups, layout };
}

function alike(one: Structure, other: Structure): boolean {
  return (
    one.connections === other.connections &&
    one.groups === other.groups &&
    one.layout === other.layout &&
    (one.elements === other.elements ||
      (one.elements.length === other.elements.length &&
        one.elements.every((e, i) => same(e, other.elements[i]))))
  );
}

// Values may differ: everything else is shared with the element before.
function same(one: ElementView, other: ElementView | undefined): boolean {
  return (
    one === other ||
    (other !== undefined &&
      one.id === other.id &&
      one.path === other.path &&
      one.kind === other.kind &&
      one.effect === other.effect &&
      one.inputs === other.inputs &&
      one.axes === other.axes)
  );
}
