// The world from above, to scale. Objects and goals are moved with the mouse.

import { useComputedColorScheme } from "@mantine/core";
import { type KeyboardEvent, type PointerEvent, useEffect, useRef } from "react";

import { pageInk } from "../widgets/look";
import type { SceneView } from "../protocol";
import { draw } from "./draw";
import type { Ground } from "./ground";
import { live } from "../server/live";
import { onWorld } from "./onWorld";
import { frameOf, inside, objects, type PlanFrame, type PlanPoint, toWorld, under } from "./planFrame";
import type { Hands } from "./useHands";

type PlanProps = {
  scene: SceneView;
  hands: Hands;
  // Where a colour is dropped.
  ground: { current: Ground | null };
};

export function Plan({ scene, hands, ground }: PlanProps) {
  const { hovered, selected, carried, carrier, refused, refuse, select, hover, put, press } = hands;
  const shade = useComputedColorScheme();
  const canvas = useRef<HTMLCanvasElement>(null);
  const frame = useRef<PlanFrame | null>(null);
  const grip = useRef<PlanPoint | null>(null);

  useEffect(() => {
    const element = canvas.current;
    if (element === null) {
      return;
    }
    const paint = () => {
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
      draw(
        ctx,
        frame.current,
        live.now,
        { hovered, selected, held: carried === null ? null : { ...carried, refused: refused !== "" } },
        pageInk(),
      );
    };
    return onWorld(element, paint);
  }, [hovered, selected, carried, refused, shade]);

  useEffect(() => {
    ground.current = {
      get scale() {
        return frame.current?.scale ?? 0;
      },
      at: (clientX, clientY) => {
        const area = canvas.current?.getBoundingClientRect();
        if (area === undefined || frame.current === null) {
          return null;
        }
        const [x, y] = [clientX - area.left, clientY - area.top];
        const outside = x < 0 || x > area.width || y < 0 || y > area.height;
        return outside ? null : inside(frame.current, toWorld(frame.current, { x, y }));
      },
    };
    return () => {
      ground.current = null;
    };
  }, [ground]);

  const all = objects(scene);
  const at = ({ nativeEvent: { offsetX: x, offsetY: y } }: { nativeEvent: MouseEvent }): PlanPoint => ({
    x,
    y,
  });
  const down = (event: PointerEvent<HTMLCanvasElement>) => {
    const object =
      frame.current === null || event.button !== 0 ? null : under(scene, frame.current, at(event));
    select(object?.name ?? null);
    refuse("");
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
      hover(under(scene, frame.current, at(event))?.name ?? bodyUnder(frame.current, at(event)));
      return;
    }
    const place = toWorld(frame.current, at(event));
    carrier.move({
      name: selected,
      at: inside(frame.current, { x: place.x + grip.current.x, y: place.y + grip.current.y }),
    });
  };
  const up = () => {
    grip.current = null;
    carrier.release();
  };
  const doubled = (event: { nativeEvent: MouseEvent }) => {
    if (frame.current !== null && under(scene, frame.current, at(event)) === null) {
      put(inside(frame.current, toWorld(frame.current, at(event))));
    }
  };
  return (
    <canvas
      ref={canvas}
      tabIndex={0}
      role="img"
      aria-label={`The world from above: ${all.map(({ name }) => name).join(", ")}`}
      style={{
        cursor:
          grip.current !== null
            ? "grabbing"
            : all.find(({ name }) => name === hovered)?.fixed === false
              ? "grab"
              : "default",
      }}
      onPointerDown={down}
      onPointerMove={move}
      onPointerUp={up}
      onPointerCancel={up}
      onPointerLeave={() => hover(null)}
      onDoubleClick={doubled}
      onKeyDown={(event: KeyboardEvent) => press(event)}
    />
  );
}

function bodyUnder(frame: PlanFrame, pixel: PlanPoint): string | null {
  const { x, y } = toWorld(frame, pixel);
  return live.now.bodies.find((body) => Math.hypot(body.x - x, body.y - y) <= body.radius)?.name ?? null;
}
