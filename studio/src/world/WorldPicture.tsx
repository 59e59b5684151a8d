// What a camera of the world sees, drawn by the world itself: for an eye, the events as they come.

import { useEffect, useRef } from "react";

import { paintBytes } from "../draw/paint";
import type { PictureView } from "../protocol";
import { live } from "./live";

export function WorldPicture({ picture }: { picture: PictureView }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { name, columns, rows } = picture;

  useEffect(() => {
    let due = 0;
    const paint = () => {
      due = 0;
      if (canvas.current !== null) {
        paintBytes(canvas.current, live.now.pixels, columns, rows);
      }
    };
    const redraw = () => {
      due ||= requestAnimationFrame(paint);
    };
    const end = live.listen(redraw);
    redraw();
    return () => {
      cancelAnimationFrame(due);
      end();
    };
  }, [columns, rows]);

  return (
    <figure className="world-camera">
      <div className="world-picture">
        <canvas ref={canvas} role="img" aria-label={`Picture of the world, ${name}`} />
      </div>
      <figcaption className="one-line">{name}</figcaption>
    </figure>
  );
}
