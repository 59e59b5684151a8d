// All live pictures on one canvas over the boxes: a browser pays for every canvas that it puts on the page,
// and hundreds of small ones cost more than one large one. Each box draws its picture on a canvas of its own
// that is not on the page; here they are copied to the positions of the boxes.

import { canvasSettings } from "../../draw/canvases";
import type { Viewport } from "@xyflow/react";

// Without a further move for this time the view is at rest, with or without a message of its end.
const STILL_MS = 400;
// The opacity of what is not brought to the fore, in graph.css too.
const FAR = 0.5;

export class LiveLayer {
  private pictures = new Map<HTMLElement, HTMLCanvasElement>();
  private canvas: HTMLCanvasElement | null = null;
  private asked = false;
  // While the view is moved: the view that the layer was painted for, and the present one.
  private from: Viewport | null = null;
  private view: Viewport | null = null;
  private still = 0;

  // Adds the canvas that shows them; returns a function that removes it.
  attach(canvas: HTMLCanvasElement): () => void {
    const observer = new ResizeObserver(() => this.change());
    observer.observe(canvas);
    this.canvas = canvas;
    return () => {
      observer.disconnect();
      this.canvas = null;
    };
  }

  add(slot: HTMLElement, picture: HTMLCanvasElement): void {
    this.pictures.set(slot, picture);
    this.change();
  }

  remove(slot: HTMLElement): void {
    this.pictures.delete(slot);
    this.change();
  }

  // Something moved or was drawn: show it with the browser's next picture.
  change(): void {
    if (!this.asked) {
      this.asked = true;
      requestAnimationFrame(() => {
        this.asked = false;
        if (this.from === null) {
          this.paint();
        }
      });
    }
  }

  // While the view is moved the layer is shifted, which costs nothing, and painted when the painter has
  // drawn; null: the view is at rest, and the layer is painted.
  move(view: Viewport | null): void {
    if (this.canvas === null) {
      return;
    }
    window.clearTimeout(this.still);
    this.view = view;
    if (view === null) {
      this.from = null;
      this.canvas.style.transform = "";
      this.change();
      return;
    }
    this.still = window.setTimeout(() => this.move(null), STILL_MS);
    this.from ??= view;
    const scale = view.zoom / this.from.zoom;
    const x = view.x - this.from.x * scale;
    const y = view.y - this.from.y * scale;
    this.canvas.style.transform = `translate(${x}px, ${y}px) scale(${scale})`;
  }

  // Show everything now, also while the view is moved.
  paint(): void {
    if (this.from !== null && this.canvas !== null) {
      this.from = this.view;
      this.canvas.style.transform = "";
    }
    const base = this.canvas?.getBoundingClientRect();
    if (this.canvas === null || base === undefined || base.width === 0) {
      return;
    }
    const ratio = Math.min(2, window.devicePixelRatio);
    const [width, height] = [Math.round(base.width * ratio), Math.round(base.height * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      Object.assign(this.canvas, { width, height });
    }
    const ctx = this.canvas.getContext("2d", canvasSettings());
    if (ctx === null) {
      return;
    }
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, base.width, base.height);
    for (const [slot, picture] of this.pictures) {
      const at = slot.getBoundingClientRect();
      if (
        at.right > base.left &&
        at.left < base.right &&
        at.bottom > base.top &&
        at.top < base.bottom &&
        picture.width > 0
      ) {
        const whole =
          picture.style.objectFit === "contain"
            ? Math.min(at.width / picture.width, at.height / picture.height)
            : 0;
        const [w, h] = whole > 0 ? [picture.width * whole, picture.height * whole] : [at.width, at.height];
        ctx.globalAlpha = slot.closest("[data-far]") === null ? 1 : FAR;
        ctx.imageSmoothingEnabled = picture.style.imageRendering !== "pixelated";
        ctx.drawImage(
          picture,
          at.left - base.left + (at.width - w) / 2,
          at.top - base.top + (at.height - h) / 2,
          w,
          h,
        );
      }
    }
  }
}
