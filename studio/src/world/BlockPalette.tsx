// Colours of blocks: a click places a block in front of the robot, or removes it where it is there; a colour
// that is dragged onto the floor places a block there.

import { type KeyboardEvent, type PointerEvent, type ReactNode, useRef, useState } from "react";
import { createPortal } from "react-dom";

import type { SceneView } from "../protocol";
import { request } from "../server/socket";
import { live } from "../server/live";
import { blockName, blockSide, colourOf, cssColour, inFront, SWATCHES, type Swatch } from "./blocks";
import type { Ground } from "./ground";
import { freeName, type PlanPoint } from "./planFrame";

// Further than this a pressed pointer drags a colour, in px.
const DRAGGED = 5;

type PaletteProps = {
  scene: SceneView;
  // The colour of the next box; null: none was chosen.
  chosen: number[] | null;
  choose: (color: number[]) => void;
  select: (name: string | null) => void;
  tell: (reason: string) => void;
  // The floor that a colour is dragged onto; null: it is not drawn.
  ground: () => Ground | null;
  children?: ReactNode;
};

export function BlockPalette({ scene, chosen, choose, select, tell, ground, children }: PaletteProps) {
  const [own, setOwn] = useState("#f08020");
  const pressed = useRef<PlanPoint | null>(null);
  const dragging = useRef(false);
  const [carried, setCarried] = useState<{ swatch: Swatch; at: PlanPoint; side: number } | null>(null);
  const present = new Set(scene.boxes.map(({ name }) => name));
  const remove = (swatch: Swatch) => {
    select(null);
    void request({ type: "remove_object", name: blockName(swatch) });
  };
  const put = (name: string, { color }: Swatch, at: PlanPoint) => {
    const side = blockSide(scene, live.now.bodies[0]);
    select(name);
    void request({ type: "place_object", name, ...at, width: side, height: side, color });
  };
  const place = (swatch: Swatch) => {
    const { bodies } = live.now;
    const at = inFront(scene, bodies, blockSide(scene, bodies[0]));
    tell(at === null ? `A block has no room in front of ${bodies[0]?.name ?? "the robot"}.` : "");
    if (at !== null) {
      put(blockName(swatch), swatch, at);
    }
  };
  const carry = (swatch: Swatch, { clientX: x, clientY: y }: PointerEvent) => {
    const from = pressed.current;
    dragging.current ||= from !== null && Math.hypot(x - from.x, y - from.y) > DRAGGED;
    const onto = dragging.current ? ground() : null;
    if (onto !== null) {
      const side = onto.scale * blockSide(scene, live.now.bodies[0]);
      setCarried({ swatch, at: { x: x - side / 2, y: y - side / 2 }, side });
    }
  };
  const drop = (swatch: Swatch, { clientX: x, clientY: y }: PointerEvent) => {
    const at = dragging.current ? (ground()?.at(x, y) ?? null) : null;
    pressed.current = null;
    setCarried(null);
    if (at !== null) {
      choose(swatch.color);
      put(freeName(scene, swatch.name), swatch, at);
    }
  };
  const swatches = [...SWATCHES, { name: "own", color: colourOf(own) }];
  return (
    <div className="flow world-palette" role="group" aria-label="Blocks in front of the robot">
      {swatches.map((swatch) => {
        const there = present.has(blockName(swatch));
        return (
          <button
            key={swatch.name}
            type="button"
            className="world-swatch"
            aria-pressed={there}
            aria-label={blockName(swatch)}
            title={
              there
                ? `Remove the ${blockName(swatch)} (Delete)`
                : `Place a ${blockName(swatch)} in front of the robot; drag it to place one elsewhere`
            }
            data-chosen={chosen !== null && String(chosen) === String(swatch.color)}
            style={{ background: cssColour(swatch.color) }}
            onPointerDown={(event) => {
              if (event.button === 0) {
                pressed.current = { x: event.clientX, y: event.clientY };
                dragging.current = false;
                event.currentTarget.setPointerCapture(event.pointerId);
              }
            }}
            onPointerMove={(event) => pressed.current !== null && carry(swatch, event)}
            onPointerUp={(event) => drop(swatch, event)}
            onPointerCancel={() => {
              pressed.current = null;
              setCarried(null);
            }}
            onClick={() => {
              if (dragging.current) {
                dragging.current = false; // the end of a drag is no click
                return;
              }
              choose(swatch.color);
              (there ? remove : place)(swatch);
            }}
            onKeyDown={(event: KeyboardEvent) => {
              if (there && (event.key === "Delete" || event.key === "Backspace")) {
                remove(swatch);
                event.preventDefault();
                event.stopPropagation(); // keys of the page do other things
              }
            }}
          />
        );
      })}
      <input
        type="color"
        className="world-own"
        aria-label="Colour of the own block"
        title="Choose the colour of the last block"
        value={own}
        onChange={(event) => {
          setOwn(event.currentTarget.value);
          choose(colourOf(event.currentTarget.value));
        }}
      />
      {children}
      {carried !== null &&
        createPortal(
          <div
            className="world-carried"
            style={{
              left: carried.at.x,
              top: carried.at.y,
              width: carried.side,
              height: carried.side,
              background: cssColour(carried.swatch.color),
            }}
          />,
          document.body, // panels are the frame of what is fixed inside them
        )}
    </div>
  );
}
