// The panel of the world: what a robot drives in or works on, from above and to scale or in three dimensions.
// Objects and goals are moved with the mouse during a run.

import "./world.css";

import { NativeSelect, SegmentedControl } from "@mantine/core";
import { useEffect, useRef, useState, useSyncExternalStore } from "react";

import { socket } from "../server/socket";
import { useStudio } from "../server/store";
import { BlockPalette } from "./BlockPalette";
import { AddCamera, CameraView, useCamera } from "./CameraView";
import type { Ground } from "./ground";
import { LinkState } from "./LinkState";
import { live } from "../server/live";
import { Plan } from "./Plan";
import { objects, placeText } from "./planFrame";
import { SolidScene } from "./SolidScene";
import { useHands } from "./useHands";
import { WorldPicture } from "./WorldPicture";

const HELP =
  "Drag an object, or a colour onto the plan. A click on a colour places a block in front of the robot, a " +
  "double click a box of that colour; Delete removes the selected one, arrow keys move it.";
const MOVING_HELP = "Drag an object, or move the chosen one with the arrow keys.";
const SOLID_HELP =
  "Drag an object to move it, a link of the robot to push it, anything else to turn the view; the right " +
  "button shifts it, the wheel comes nearer. A double click places a box.";
const NOTHING =
  "Nothing to see from above. Start the studio with a world that has a plan, for example: " +
  "deodar studio FILE --world arena:blocks";
const REMOTE = "The robot is in another process, and has no view from above.";
const VIEWS = [
  { value: "solid", label: "3-D" },
  { value: "plan", label: "From above" },
];

export function World() {
  const scene = useSyncExternalStore(live.listen, live.scene);
  const note = useSyncExternalStore(live.listen, live.note);
  const hasCamera = useSyncExternalStore(live.listen, live.camera);
  const hasSolids = useSyncExternalStore(live.listen, live.solid);
  const canPlace = useSyncExternalStore(live.listen, live.canPlace);
  const picture = useSyncExternalStore(live.listen, live.picture);
  const remote = useSyncExternalStore(live.listen, () => live.link() !== null);
  const record = useStudio((state) => state.document?.record != null);
  const open = useStudio((state) => state.connection === "open");
  const camera = useCamera();
  const hands = useHands(scene);
  const ground = useRef<Ground | null>(null);
  const [view, setView] = useState("solid");
  const solid = hasSolids && view === "solid";

  useEffect(() => {
    if (open) {
      socket.post({ type: "watch_world", on: true, solid });
      return () => socket.post({ type: "watch_world", on: false });
    }
    return undefined;
  }, [open, solid]);

  if (scene === null) {
    return (
      <>
        <LinkState />
        <p className="world-none dim" role="status">
          {note !== ""
            ? note
            : record
              ? "The world of this record has no view from above."
              : remote
                ? REMOTE
                : NOTHING}
        </p>
      </>
    );
  }

  const { hovered, selected, carried, refused, refuse } = hands;
  const all = objects(scene);
  const find = (name: string | null) => all.find((object) => object.name === name);
  const looked =
    find(carried?.name ?? hovered ?? selected) ?? live.now.bodies.find(({ name }) => name === hovered);
  const told =
    looked === undefined
      ? note !== ""
        ? note
        : record
          ? "The objects are at their places at the start of the run."
          : solid
            ? SOLID_HELP
            : canPlace
              ? HELP
              : MOVING_HELP
      : `${looked.name}: ${placeText(carried?.at ?? looked, scene.border, scene.unit)}`;
  return (
    <section className="world" aria-label={solid ? "World in three dimensions" : "World from above"}>
      <header className="flow world-head">
        {hasSolids && (
          <SegmentedControl aria-label="View of the world" data={VIEWS} value={view} onChange={setView} />
        )}
        <NativeSelect
          variant="unstyled"
          aria-label="Object to move"
          value={selected ?? ""}
          data={[
            { value: "", label: "nothing chosen" },
            ...all.filter(({ fixed }) => !fixed).map(({ name }) => ({ value: name, label: name })),
          ]}
          onChange={(event) => hands.select(event.currentTarget.value || null)}
        />
        <span
          className={`world-told dim one-line numbers${refused === "" ? "" : " world-refused"}`}
          role="status"
          title={refused === "" ? told : refused}
        >
          {refused === "" ? told : refused}
        </span>
      </header>
      <LinkState />
      {!record && canPlace && (
        <BlockPalette
          scene={scene}
          chosen={hands.colour}
          choose={hands.choose}
          select={hands.select}
          tell={refuse}
          ground={() => ground.current}
        >
          {camera === null && hasCamera && <AddCamera />}
        </BlockPalette>
      )}
      <div className="world-body">
        <div className="world-plan">
          {solid ? (
            <SolidScene scene={scene} hands={hands} ground={ground} />
          ) : (
            <Plan scene={scene} hands={hands} ground={ground} />
          )}
        </div>
        {camera !== null && <CameraView camera={camera} />}
        {picture !== null && <WorldPicture picture={picture} />}
      </div>
    </section>
  );
}
