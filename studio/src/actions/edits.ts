// Changes of the architecture, each one message to the server and one step of undo.

import { movesOf } from "./arrange";
import type { Answer, Kind } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import type { Values } from "../model/values";
import type { End, WireEnds } from "../model/ends";
import { showMade } from "./made";
import { pathOf, type Placing } from "./placing";

export type Adding = {
  values?: Values;
  // Its name, with a number where that is taken; without one it is named after its kind.
  name?: string;
  // The ends of connections to the new element.
  source?: End;
  target?: End;
  // The connection into which it is inserted.
  wire?: WireEnds;
  // The connection that is removed.
  replaces?: WireEnds;
};

export async function addElement(kind: string, spot: Placing, adding: Adding = {}): Promise<void> {
  const document = useStudio.getState().document;
  const { values = {}, name = "", source = null, target = null, wire = null, replaces = null } = adding;
  const answer = await request({
    type: "add_element",
    kind,
    values,
    name,
    group: document === null ? [] : pathOf(spot.group, document),
    at: [spot.at.x, spot.at.y],
    source,
    target,
    wire,
    replaces,
    ...(spot.moves === undefined ? {} : movesOf(spot.moves)),
  });
  showMade(answer.made ?? []);
}

// Add a model as a group.
export async function addTemplate(name: string, spot: Placing): Promise<void> {
  const document = useStudio.getState().document;
  const answer = await request({
    type: "add_template",
    name,
    group: document === null ? [] : pathOf(spot.group, document),
    at: [spot.at.x, spot.at.y],
  });
  showMade(answer.made ?? []);
}

// Add a part to a list of parts, such as a kernel, or put it into the place of another.
export function addPart(element: string, parameter: string, several: boolean, part: Kind): Promise<Answer> {
  const value = part.example ?? { kind: part.name };
  const before = useStudio.getState().elements.get(element)?.values[parameter];
  return request({
    type: "set",
    element,
    parameter,
    value: several ? [...(Array.isArray(before) ? before : []), value] : value,
  });
}

export const connect = (ends: WireEnds): Promise<Answer> => request({ type: "connect", ...ends });

// Move the ends of a connection.
export const reconnect = (before: WireEnds, after: WireEnds): Promise<Answer> =>
  request({ type: "reconnect", old: before, new: after });
