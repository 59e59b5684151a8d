// The panel of the world: what a robot drives in, from above and to scale. Objects and goals are moved with
// the mouse during a run.

import "./world.css";

import { NativeSelect, useComputedColorScheme } from "@mantine/core";
import {
  type KeyboardEvent,
  type PointerEvent,
  useEffect,
  useRef,
  useState,
  useSyncExternalStore,
} from "react";

import { pageLook } from "../plots/colors/look";
import { request, socket } from "../socket";
import { useStudio } from "../store";
import { BlockPalette } from "./BlockPalette";
import { blockSide } from "./blocks";
import { AddCamera, CameraView, useCamera } from "./CameraView";
import { Carrier } from "./carrier";
import { draw } from "./draw";
import { live } from "./live";
import {
  type PlanFrame,
  frameOf,
  freeName,
  inside,
  placeText,
  type PlanPoint,
  objects,
  toWorld,
  under,
} from "./plan";

const HELP =
  "Drag an object, or a colour onto the plan. A click on a colour places a block in front of the robot, a " +
  "double click a box of that colour; Delete removes the selected one, arrow keys move it.";
const NOTHING =
  "Nothing to see from above. Start the studio with a world that has a plan, for example: " +
  "deodar studio FILE --world arena:blocks";
// A step of an arrow key, as a share of the longer side.
const STEP = 0.01;
const ARROWS: Record<string, PlanPoint> = {
  ArrowLeft: { x: -1, y: 0 },
  ArrowRight: { x: 1, y: 0 },
  ArrowUp: { x: 0, y: 1 },
  ArrowDown: { x: 0, y: -1 },
};

export function World() {
  const scene = useSyncExternalStore(live.listen, live.scene);
  const note = useSyncExternalStore(live.listen, live.note);
  const hasCamera = useSyncExternalStore(live.listen, live.camera);
  const record = useStudio((state) => state.document?.record != null);
  const open = useStudio((state) => state.connection === "open");
  const camera = useCamera();
  const shade = useComputedColorScheme();
  const canvas = useRef<HTMLCanvasElement>(null);
  const frame = useRef<PlanFrame | null>(null);
  const grip = useRef<PlanPoint | null>(null);
  const redraw = useRef(() => {});
  const [hovered, setHovered] = useState<string | null>(null);
  const [selected, setSelected] = useState<string | null>(null);
  const [carrier, setCarrier] = useState<{ held: Carrier["held"]; refused: string }>({
    held: null,
    refused: "",
  });
  const [colour, setColour] = useState<number[] | null>(null);
  const hand = useRef<Carrier | null>(null);
  hand.current ??= new Carrier(
    async (message) => (await socket.ask(message)).answer,
    () => hand.current !== null && setCarrier({ held: hand.current.held, refused: hand.current.refused }),
  );

  useEffect(() => {
    if (open) {
      socket.post({ type: "watch_world", on: true });
      return () => socket.post({ type: "watch_world", on: false });
    }
    return undefined;
  }, [open]);

  useEffect(() => {
    const element = canvas.current;
    if (element === null) {
      return;
    }
    let due = 0;
    const paint = () => {
      due = 0;
      const { clientWidth: width, clientHeight: height } = element;
      const ctx = element.getContext("2d");
      const border = live.now.scene?.border;
      if (ctx === null || border === undefined || width === 0) {
        return;
      }
      const fine = devicePixelRatio;
      if (element.width !== Math.round(width * fine) || element.height !== Math.round(height * fine)) {
        element.width = Math.round(width * fine);
        element.height = Math.round(height * fine);
      }
      ctx.setTransform(fine, 0, 0, fine, 0, 0);
      ctx.clearRect(0, 0, width, height);
      frame.current = frameOf(border, width, height);
      const { held, refused } = carrier;
      draw(
        ctx,
        frame.current,
        live.now,
        { hovered, selected, held: held === null ? null : { ...held, refused: refused !== "" } },
        pageLook(),
      );
    };
    redraw.current = () => {
      due ||= requestAnimationFrame(paint);
    };
    const sizes = new ResizeObserver(() => redraw.current());
    sizes.observe(element);
    const end = live.listen(() => redraw.current());
    redraw.current();
    return () => {
      cancelAnimationFrame(due);
      sizes.disconnect();
      end();
    };
  }, [scene === null, hovered, selected, carrier, shade]);

  if (scene === null) {
    return (
      <p className="world-none dim" role="status">
        {note !== "" ? note : record ? "The world of this record has no view from above." : NOTHING}
      </p>
    );
  }

  const all = objects(scene);
  const find = (name: string | null) => all.find((object) => object.name === name);
  const at = ({ nativeEvent: { offsetX: x, offsetY: y } }: { nativeEvent: MouseEvent }): PlanPoint => ({
    x,
    y,
  });
  const down = (event: PointerEvent<HTMLCanvasElement>) => {
    const object =
      frame.current === null || event.button !== 0 ? null : under(scene, frame.current, at(event));
    setSelected(object?.name ?? null);
    hand.current?.forgive();
    if (object !== null && !object.fixed && frame.current !== null) {
      const place = toWorld(frame.current, at(event));
      grip.current = { x: object.x - place.x, y: object.y - place.y };
      event.currentTarget.setPointerCapture(event.pointerId);
    }
  };
  const move = (event: PointerEvent<HTMLCanvasElement>) => {
    if (frame.current === null) {
      return;
    }
    if (grip.current === null || selected === null) {
      setHovered(under(scene, frame.current, at(event))?.name ?? bodyUnder(frame.current, at(event)));
      return;
    }
    const place = toWorld(frame.current, at(event));
    hand.current?.carry(
      selected,
      inside(frame.current, { x: place.x + grip.current.x, y: place.y + grip.current.y }),
    );
  };
  const up = () => {
    grip.current = null;
    hand.current?.drop();
  };
  const put = (event: { nativeEvent: MouseEvent }) => {
    if (frame.current !== null && under(scene, frame.current, at(event)) === null) {
      const size = blockSide(scene, live.now.bodies[0]);
      void request({
        type: "place_object",
        name: freeName(scene),
        ...inside(frame.current, toWorld(frame.current, at(event))),
        width: size,
        height: size,
        ...(colour === null ? {} : { color: colour }),
      });
    }
  };
  const key = (event: KeyboardEvent) => {
    const [object, arrow, border] = [find(selected), ARROWS[event.key], frame.current?.border];
    if (object === undefined || border === undefined || frame.current === null) {
      return;
    }
    if (arrow !== undefined) {
      const step = STEP * Math.max(border[2] - border[0], border[3] - border[1]);
      hand.current?.carry(
        object.name,
        inside(frame.current, { x: object.x + step * arrow.x, y: object.y + step * arrow.y }),
      );
      hand.current?.drop();
    } else if (event.key === "Delete" || event.key === "Backspace") {
      void request({ type: "remove_object", name: object.name });
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation(); // keys of the page do other things
  };

  const looked =
    find(carrier.held?.name ?? hovered ?? selected) ?? live.now.bodies.find(({ name }) => name === hovered);
  const told =
    looked === undefined
      ? note !== ""
        ? note
        : record
          ? "The objects are at their places at the start of the run."
          : HELP
      : `${looked.name}: ${placeText(carrier.held?.at ?? looked, scene.border, scene.unit)}`;
  return (
    <section className="world" aria-label="World from above">
      <header className="world-head">
        <NativeSelect
          size="xs"
          variant="unstyled"
          aria-label="Object to move"
          value={selected ?? ""}
          data={[
            { value: "", label: "nothing chosen" },
            ...all.filter(({ fixed }) => !fixed).map(({ name }) => ({ value: name, label: name })),
          ]}
          onChange={(event) => setSelected(event.currentTarget.value || null)}
        />
        <span
          className={`world-told one-line numbers${carrier.refused === "" ? "" : " world-refused"}`}
          role="status"
          title={carrier.refused === "" ? told : carrier.refused}
        >
          {carrier.refused === "" ? told : carrier.refused}
        </span>
      </header>
      {!record && (
        <BlockPalette
          scene={scene}
          chosen={colour}
          choose={setColour}
          select={setSelected}
          tell={(reason) => hand.current?.refuse(reason)}
          plan={() =>
            canvas.current === null || frame.current === null
              ? null
              : { area: canvas.current.getBoundingClientRect(), frame: frame.current }
          }
        >
          {camera === null && hasCamera && <AddCamera />}
        </BlockPalette>
      )}
      <div className="world-body">
        <div className="world-plan">
          <canvas
            ref={canvas}
            tabIndex={0}
            role="img"
            aria-label={`The world from above: ${all.map(({ name }) => name).join(", ")}`}
            style={{
              cursor:
                grip.current !== null ? "grabbing" : find(hovered)?.fixed === false ? "grab" : "default",
            }}
            onPointerDown={down}
            onPointerMove={move}
            onPointerUp={up}
            onPointerCancel={up}
            onPointerLeave={() => setHovered(null)}
            onDoubleClick={put}
            onKeyDown={key}
          />
        </div>
        {camera !== null && <CameraView camera={camera} />}
      </div>
    </section>
  );
}

function bodyUnder(frame: PlanFrame, pixel: PlanPoint): string | null {
  const { x, y } = toWorld(frame, pixel);
  return live.now.bodies.find((body) => Math.hypot(body.x - x, body.y - y) <= body.radius)?.name ?? null;
}
