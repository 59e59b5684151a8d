// The world in three dimensions: its solids, which move while it runs. Objects are dragged over the floor,
// bodies of a robot are pushed, and everything else turns the view.

import { Switch } from "@mantine/core";
import { type KeyboardEvent, useEffect, useRef, useState } from "react";

import { Held } from "../server/held";
import type { SceneView } from "../protocol";
import { socket } from "../server/socket";
import type { Ground } from "./ground";
import { live } from "../server/live";
import { objects, type PlanPoint, within } from "./planFrame";
import type { Hands } from "./useHands";
import { onPictures, useWebGL } from "../plots/scenes/useWebGL";
import { useLatest } from "../widgets/useLatest";
import type { Point3 } from "../model/sceneView";
import { force } from "./pull";
import type { SolidStage } from "./solidStage";

const NO_WEBGL =
  'This browser has no WebGL, which this view needs. Choose "From above", or allow WebGL in the settings ' +
  "of the browser.";
// Degrees of an arrow key, and how much nearer + comes.
const TURN = 15;
const NEARER = 1.2;

type SolidSceneProps = { scene: SceneView; hands: Hands; ground: { current: Ground | null } };

// What the pointer holds.
type Gripped =
  | { object: string; height: number; grip: PlanPoint }
  | { body: string; index: number; own: Point3; pointer: Point3 };

export function SolidScene({ scene, hands, ground }: SolidSceneProps) {
  const stage = useRef<SolidStage | null>(null);
  const [follow, setFollow] = useState(false);
  const latest = useLatest({ scene, hands, follow });
  const { host, problem } = useWebGL(NO_WEBGL, async () => {
    const { SolidStage: Made } = await import("./solidStage");
    return (place) => show(place, Made, stage, ground, () => latest.current);
  });
  const { hovered, selected } = hands;
  useEffect(() => {
    stage.current?.mark(({ thing }) => thing !== "" && (thing === selected || thing === hovered));
  }, [hovered, selected]);

  const names = objects(scene).map(({ name }) => name);
  const key = (event: KeyboardEvent) => {
    const turn = TURNS[event.key];
    if (hands.press(event) || turn === undefined || event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    event.preventDefault();
    event.stopPropagation(); // the arrow keys also show moments of the past
    stage.current?.turn(...turn);
  };
  return (
    <>
      <div
        ref={host}
        className="world-solid"
        tabIndex={0}
        role="img"
        aria-label={`The world in three dimensions: ${names.join(", ")}`}
        onKeyDown={key}
      />
      {problem === "" ? (
        <Switch
          className="world-follow"
          label="Follow"
          checked={follow}
          onChange={(event) => setFollow(event.currentTarget.checked)}
        />
      ) : (
        <p className="world-none" role="alert">
          {problem}
        </p>
      )}
    </>
  );
}

const TURNS: Record<string, [azimuth: number, elevation: number, nearer?: number]> = {
  ArrowLeft: [-TURN, 0],
  ArrowRight: [TURN, 0],
  ArrowUp: [0, TURN],
  ArrowDown: [0, -TURN],
  "+": [0, 0, NEARER],
  "-": [0, 0, 1 / NEARER],
};

type Now = { scene: SceneView; hands: Hands; follow: boolean };

// Draw on a new canvas and listen to the pointer; return a function that ends both.
function show(
  host: HTMLElement,
  Stage: typeof SolidStage,
  shown: { current: SolidStage | null },
  ground: { current: Ground | null },
  now: () => Now,
): () => void {
  const canvas = document.createElement("canvas");
  host.append(canvas);
  const { redraw, end } = onPictures(host, draw);
  const made = new Stage(canvas, redraw);
  shown.current = made;
  const puller = new Held<{ body: string; force: Point3 }>(async ({ body, force }) => {
    const { answer } = await socket.ask({ type: "push_body", body, force: [...force] });
    now().hands.refuse(answer.problems?.[0]?.what ?? "");
  });
  let held: Gripped | null = null;

  const pull = () => {
    if (held !== null && "body" in held) {
      const grip = made.now(held.index, held.own);
      puller.move({ body: held.body, force: force(grip, held.pointer) });
      made.point([grip, held.pointer]);
    }
  };
  function draw() {
    const { clientWidth: width, clientHeight: height } = host;
    if (width === 0 || height === 0) {
      return;
    }
    made.frame(now().scene.border as [number, number, number, number], width / height);
    const { solids, poses, bodies } = live.now;
    made.show(solids);
    made.place(poses);
    made.follow(now().follow && bodies[0] !== undefined ? bodies[0] : null);
    pull();
    made.render(width, height, devicePixelRatio);
    host.dataset["solids"] = String(solids.length);
  }
  const onCanvas = ({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] => {
    const { left, top } = canvas.getBoundingClientRect();
    return [clientX - left, clientY - top];
  };
  const release = () => {
    made.controls.enabled = true;
    if (held !== null && "body" in held) {
      puller.move({ body: held.body, force: [0, 0, 0] });
      puller.release();
      made.point(null);
      redraw();
    } else if (held !== null) {
      now().hands.carrier.release();
    }
    held = null;
  };
  // before the controls of the view, which listen on the canvas
  const down = (event: PointerEvent) => {
    const { scene, hands } = now();
    const [x, y] = onCanvas(event);
    const hit = event.button === 0 ? made.hit(x, y) : null;
    hands.refuse("");
    const object = scene.boxes.find(({ name, fixed }) => name === hit?.solid.thing && !fixed);
    hands.select(object?.name ?? null);
    if (hit === null || (object === undefined && !hit.solid.pushable)) {
      return;
    }
    made.controls.enabled = false;
    host.setPointerCapture(event.pointerId);
    const [px, py, height] = hit.point;
    held =
      object === undefined
        ? {
            body: hit.solid.body,
            index: hit.index,
            own: made.own(hit.index, hit.point),
            pointer: hit.point,
          }
        : { object: object.name, height, grip: { x: object.x - px, y: object.y - py } };
  };
  const move = (event: PointerEvent) => {
    const { scene, hands } = now();
    const [x, y] = onCanvas(event);
    if (held === null) {
      if (event.buttons === 0) {
        hands.hover(made.hit(x, y)?.solid.thing || null);
      }
    } else if ("body" in held) {
      held.pointer = made.beside(x, y, made.now(held.index, held.own));
      redraw();
    } else {
      const at = made.level(x, y, held.height);
      if (at !== null) {
        const place = { x: at.x + held.grip.x, y: at.y + held.grip.y };
        hands.carrier.move({ name: held.object, at: within(scene.border, place) });
      }
    }
  };
  const doubled = (event: MouseEvent) => {
    const { scene, hands } = now();
    const [x, y] = onCanvas(event);
    const at = made.level(x, y, 0);
    if (made.hit(x, y)?.solid.thing === "" && at !== null) {
      hands.put(within(scene.border, at));
    }
  };
  const listening = new AbortController();
  const { signal } = listening;
  host.addEventListener("pointerdown", down, { signal, capture: true });
  host.addEventListener("pointermove", move, { signal });
  host.addEventListener("pointerup", release, { signal });
  host.addEventListener("pointercancel", release, { signal });
  host.addEventListener("pointerleave", () => now().hands.hover(null), { signal });
  host.addEventListener("dblclick", doubled, { signal });
  const unlisten = live.listen(redraw);
  ground.current = {
    get scale() {
      return made.scale();
    },
    at: (clientX, clientY) => {
      const { width, height } = canvas.getBoundingClientRect();
      const [x, y] = onCanvas({ clientX, clientY });
      const at = x < 0 || x > width || y < 0 || y > height ? null : made.level(x, y, 0);
      return at === null ? null : within(now().scene.border, at);
    },
  };
  redraw();
  return () => {
    release();
    end();
    listening.abort();
    unlisten();
    ground.current = null;
    shown.current = null;
    made.end();
    canvas.remove();
  };
}
