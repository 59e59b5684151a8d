// What a camera of the world sees, drawn by the world itself: for an eye, the events as they come.

import { useEffect, useRef } from "react";

import { paintBytes } from "../draw/paint";
import type { PictureView } from "../protocol";
import { live } from "../server/live";
import { onWorld } from "./onWorld";

export function WorldPicture({ picture }: { picture: PictureView }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { name, columns, rows } = picture;

  useEffect(() => {
    const element = canvas.current;
    return element === null
      ? undefined
      : onWorld(element, () => paintBytes(element, live.now.pixels, columns, rows));
  }, [columns, rows]);

  return (
    <figure className="world-camera">
      <div className="world-picture">
        <canvas ref={canvas} role="img" aria-label={`Picture of the world, ${name}`} />
      </div>
      <figcaption className="dim one-line">{name}</figcaption>
    </figure>
  );
}
