// What the user has in hand in the world, in each of its views: the chosen object, the one under the pointer,
// and the one that is carried.

import { type KeyboardEvent, useState } from "react";

import type { SceneView } from "../protocol";
import { Held } from "../server/held";
import { request, socket } from "../server/socket";
import { blockSide } from "./blocks";
import { live } from "../server/live";
import { freeName, objects, type PlanPoint, within } from "./planFrame";

// A step of an arrow key, as a share of the longer side.
const STEP = 0.01;
const ARROWS: Record<string, PlanPoint> = {
  ArrowLeft: { x: -1, y: 0 },
  ArrowRight: { x: 1, y: 0 },
  ArrowUp: { x: 0, y: 1 },
  ArrowDown: { x: 0, y: -1 },
};

type ObjectInHand = { name: string; at: PlanPoint };

export type Hands = {
  hovered: string | null;
  selected: string | null;
  // The carried object, and what carries it.
  carried: ObjectInHand | null;
  carrier: Held<ObjectInHand>;
  // Why the last place or push was refused; empty: it was not.
  refused: string;
  refuse: (reason: string) => void;
  colour: number[] | null;
  hover: (name: string | null) => void;
  select: (name: string | null) => void;
  choose: (colour: number[]) => void;
  // Place a box of the chosen colour.
  put: (at: PlanPoint) => void;
  // Move or remove the chosen object with a key; whether the key did something.
  press: (event: KeyboardEvent) => boolean;
};

export function useHands(scene: SceneView | null): Hands {
  const [hovered, hover] = useState<string | null>(null);
  const [selected, select] = useState<string | null>(null);
  const [colour, choose] = useState<number[] | null>(null);
  const [carried, setCarried] = useState<ObjectInHand | null>(null);
  const [refused, refuse] = useState("");
  const [carrier] = useState(
    () =>
      new Held<ObjectInHand>(async ({ name, at }) => {
        const { answer } = await socket.ask({ type: "move_object", name, x: at.x, y: at.y });
        const [problem] = answer.problems ?? [];
        refuse([problem?.where, problem?.what].filter((part) => part).join(": "));
      }, setCarried),
  );
  const put = (at: PlanPoint) => {
    if (scene !== null && live.now.canPlace) {
      const size = blockSide(scene, live.now.bodies[0]);
      void request({
        type: "place_object",
        name: freeName(scene),
        ...at,
        width: size,
        height: size,
        ...(colour === null ? {} : { color: colour }),
      });
    }
  };
  const press = (event: KeyboardEvent) => {
    const object = scene === null ? undefined : objects(scene).find(({ name }) => name === selected);
    const arrow = ARROWS[event.key];
    if (scene === null || object === undefined) {
      return false;
    }
    if (arrow !== undefined) {
      const [x0, y0, x1, y1] = scene.border as [number, number, number, number];
      const step = STEP * Math.max(x1 - x0, y1 - y0);
      const place = { x: object.x + step * arrow.x, y: object.y + step * arrow.y };
      carrier.move({ name: object.name, at: within(scene.border, place) });
      carrier.release();
    } else if (event.key === "Delete" || event.key === "Backspace") {
      void request({ type: "remove_object", name: object.name });
    } else {
      return false;
    }
    event.preventDefault();
    event.stopPropagation(); // keys of the page do other things
    return true;
  };
  return { hovered, selected, carried, carrier, refused, refuse, colour, hover, select, choose, put, press };
}
