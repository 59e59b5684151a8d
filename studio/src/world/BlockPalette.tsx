// Colours of blocks: a click places a block in front of the robot, or removes it where it is there.

import { type KeyboardEvent, type ReactNode, useState } from "react";

import type { SceneView } from "../protocol";
import { request } from "../socket";
import { live } from "./live";
import { blockName, blockSide, colourOf, cssColour, inFront, SWATCHES, type Swatch } from "./blocks";

type PaletteProps = {
  scene: SceneView;
  // The colour of the next box; null: none was chosen.
  chosen: number[] | null;
  choose: (color: number[]) => void;
  select: (name: string | null) => void;
  tell: (reason: string) => void;
  children?: ReactNode;
};

export function BlockPalette({ scene, chosen, choose, select, tell, children }: PaletteProps) {
  const [own, setOwn] = useState("#f08020");
  const present = new Set(scene.boxes.map(({ name }) => name));
  const remove = (name: string) => {
    select(null);
    void request({ type: "remove_object", name });
  };
  const place = (swatch: Swatch) => {
    const { bodies } = live.now;
    const side = blockSide(scene, bodies[0]);
    const at = inFront(scene, bodies, side);
    tell(at === null ? `A block has no room in front of ${bodies[0]?.name ?? "the robot"}.` : "");
    if (at !== null) {
      const name = blockName(swatch);
      select(name);
      void request({ type: "place_object", name, ...at, width: side, height: side, color: swatch.color });
    }
  };
  const swatches = [...SWATCHES, { name: "own", color: colourOf(own) }];
  return (
    <div className="world-palette" role="group" aria-label="Blocks in front of the robot">
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
                : `Place a ${blockName(swatch)} in front of the robot`
            }
            data-chosen={chosen !== null && String(chosen) === String(swatch.color)}
            style={{ background: cssColour(swatch.color) }}
            onClick={() => {
              choose(swatch.color);
              if (there) {
                remove(blockName(swatch));
              } else {
                place(swatch);
              }
            }}
            onKeyDown={(event: KeyboardEvent) => {
              if (there && (event.key === "Delete" || event.key === "Backspace")) {
                remove(blockName(swatch));
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
    </div>
  );
}
