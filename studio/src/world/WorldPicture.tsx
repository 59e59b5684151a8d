// What a camera of the world sees, drawn by the world itself: for an eye, the events as they come.

import { useEffect, useRef } from "react";

import type { PictureView } from "../protocol";
import { live } from "./live";

export function WorldPicture({ picture }: { picture: PictureView }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { name, columns, rows } = picture;

  useEffect(() => {
    const ctx = canvas.current?.getContext("2d") ?? null;
    if (ctx === null) {
      return;
    }
    const image = ctx.createImageData(columns, rows);
    let due = 0;
    const paint = () => {
      due = 0;
      const { pixels } = live.now;
      if (pixels.length === 3 * columns * rows) {
        for (let from = 0, to = 0; from < pixels.length; from += 3, to += 4) {
          image.data.set(pixels.subarray(from, from + 3), to);
          image.data[to + 3] = 255;
        }
        ctx.putImageData(image, 0, 0);
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
        <canvas
          ref={canvas}
          width={columns}
          height={rows}
          role="img"
          aria-label={`Picture of the world, ${name}`}
        />
      </div>
      <figcaption className="one-line">{name}</figcaption>
    </figure>
  );
}
