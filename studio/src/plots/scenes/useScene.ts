// A scene in three dimensions that fills its place: the frame on one canvas, and above it what three.js
// draws. The pointer and the arrow keys turn it, the wheel and + and - magnify it. The cursor of all plots is
// lines on it: what lies under the pointer, or where the pointer in another plot is.

import { useComputedColorScheme } from "@mantine/core";
import { type RefObject, useEffect, useRef } from "react";
import type { ListedProblem } from "../../protocol";
import { type DrawingFormat, exportScene } from "../export/exportDrawing";
import { type Coordinate, linkedCursor, valueOn } from "../linked";
import { pageInk } from "../../widgets/look";
import { drawSceneFrame, type SceneFrame } from "../export/sceneFrame";
import { FIRST_VIEW, turned, type Viewpoint, zoomed } from "../../model/sceneView";
import type { Hit, SceneStage } from "./sceneStage";
import { useLatest } from "../../widgets/useLatest";
import { onPictures, useWebGL } from "./useWebGL";

// Positions on the axes of the box; null where there is none.
export type ScenePosition = readonly (number | null)[];

export type SceneContent = {
  // What it shows, in words.
  label: string;
  view: Viewpoint | null;
  keep: (view: Viewpoint) => void;
  // What lies at positions on the axes of the box, in words; `slice` is the axis of the slice with the
  // pointer.
  read: (at: ScenePosition, slice: Hit["slice"]) => string;
  // Put the values on the stage and return what surrounds them; null: there are none yet.
  show: (stage: SceneStage, view: Viewpoint) => SceneFrame | null;
};

export type SceneRefs = {
  host: RefObject<HTMLDivElement | null>;
  redraw: () => void;
  // Why nothing can be drawn.
  problem: ListedProblem | null;
  exportAs: (title: string, format: DrawingFormat) => void;
};

const NO_WEBGL = "This browser has no WebGL, which plots in three dimensions need.";
const FIX = 'Choose "Heat map" under "Show as", or allow WebGL in the settings of the browser.';

const KEYS: Record<string, (view: Viewpoint) => Viewpoint> = {
  ArrowLeft: (view) => turned(view, -20, 0),
  ArrowRight: (view) => turned(view, 20, 0),
  ArrowUp: (view) => turned(view, 0, -20),
  ArrowDown: (view) => turned(view, 0, 20),
  "+": (view) => zoomed(view, 1.15),
  "-": (view) => zoomed(view, 1 / 1.15),
};

export function useScene(made: SceneContent): SceneRefs {
  const scene = useRef<LiveScene | null>(null);
  const latest = useLatest(made);
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });
  const { host, problem } = useWebGL(NO_WEBGL, async () => {
    const { SceneStage: Made } = await import("./sceneStage");
    return (place) => {
      const begun = new LiveScene(place, new Made(document.createElement("canvas")), () => latest.current);
      scene.current = begun;
      begun.redraw();
      return () => {
        begun.end();
        scene.current = null;
      };
    };
  });
  useEffect(() => scene.current?.redraw(), [scheme, made.label]);

  return {
    host,
    redraw: () => scene.current?.redraw(),
    problem: problem === "" ? null : { what: problem, fix: FIX },
    exportAs: (title, format) => scene.current?.export(title, format),
  };
}

class LiveScene {
  private below = document.createElement("canvas");
  private above: HTMLCanvasElement;
  private words = document.createElement("div");
  private frame: SceneFrame | null = null;
  private pointed: Hit | null = null;
  private linked: Coordinate[] = [];
  private unlink: () => void;
  private view: Viewpoint;
  private listening = new AbortController();
  private pictures: ReturnType<typeof onPictures>;

  constructor(
    private host: HTMLElement,
    private stage: SceneStage,
    private content: () => SceneContent,
  ) {
    this.above = stage.canvas;
    for (const canvas of [this.below, this.above]) {
      canvas.className = "plot-scene";
      host.append(canvas);
    }
    this.words.className = "plot-readout numbers";
    host.append(this.words);
    this.above.setAttribute("role", "img");
    this.view = content().view ?? FIRST_VIEW;
    this.pictures = onPictures(host, () => this.draw());
    this.unlink = linkedCursor.listen(this, (coordinates) => {
      this.linked = coordinates;
      this.redraw();
    });
    this.listen();
  }

  // Draw with the next picture of the browser.
  redraw(): void {
    this.pictures.redraw();
  }

  export(title: string, format: DrawingFormat): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    const frame = this.content().show(this.stage, this.view);
    if (frame !== null) {
      this.stage.showCursor([], "");
      this.stage.render(this.view, width, height, 2);
      exportScene(title, { width, height, frame, view: this.view, image: this.above }, format);
      this.redraw();
    }
  }

  end(): void {
    this.point(null);
    this.unlink();
    this.pictures.end();
    this.listening.abort();
    this.stage.end();
    this.below.remove();
    this.above.remove();
    this.words.remove();
    delete this.host.dataset["linked"];
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    const { label, show } = this.content();
    const frame = width > 0 && height > 0 ? show(this.stage, this.view) : null;
    if (frame === null) {
      return;
    }
    this.above.setAttribute("aria-label", label);
    this.below.width = Math.round(width * devicePixelRatio);
    this.below.height = Math.round(height * devicePixelRatio);
    const ctx = this.below.getContext("2d");
    if (ctx !== null) {
      drawSceneFrame(ctx, frame, this.view, { ...pageInk(), unit: devicePixelRatio }, width, height);
    }
    this.frame = frame;
    this.showCursor(frame);
    this.stage.render(this.view, width, height, devicePixelRatio);
  }

  private showCursor(frame: SceneFrame): void {
    const at = this.pointed === null ? linkedTo(frame, this.linked) : pointedAt(frame, this.pointed);
    const shares = at.map((value, d) => {
      const [lower, upper] = frame.axes[d]?.range ?? [0, 1];
      return value === null ? null : (value - lower) / (upper - lower);
    });
    const some = at.some((value) => value !== null);
    this.stage.showCursor(shares, pageInk().text);
    this.words.textContent = some ? this.content().read(at, this.pointed?.slice ?? null) : "";
    if (some && this.pointed === null) {
      this.host.dataset["linked"] = ["x", "y", "z"].filter((_, d) => at[d] != null).join("");
    } else {
      delete this.host.dataset["linked"];
    }
  }

  // Pass on what the pointer points at; null: nothing.
  private point(hit: Hit | null): void {
    if (hit === null && this.pointed === null) {
      return;
    }
    this.pointed = hit;
    const frame = this.frame;
    const at = hit === null || frame === null ? [] : pointedAt(frame, hit);
    linkedCursor.point(
      this,
      at.flatMap((value, d) => {
        const along = frame?.axes[d]?.along;
        return value === null || along === undefined ? [] : [{ along, value }];
      }),
    );
    this.redraw();
  }

  private turn(view: Viewpoint): void {
    this.view = view;
    this.redraw();
  }

  private listen(): void {
    const { host } = this;
    const on = <K extends keyof HTMLElementEventMap>(type: K, act: (event: HTMLElementEventMap[K]) => void) =>
      host.addEventListener(type, act, { signal: this.listening.signal, passive: false });
    const turnAndKeep = (event: Event, view: Viewpoint) => {
      event.preventDefault();
      this.turn(view);
      this.content().keep(view);
    };
    on("pointerdown", ({ button, pointerId }) => button === 0 && host.setPointerCapture(pointerId));
    on("pointermove", ({ pointerId, movementX, movementY, clientX, clientY }) => {
      if (host.hasPointerCapture(pointerId)) {
        this.point(null);
        this.turn(turned(this.view, movementX, movementY));
      } else {
        const { left, top } = host.getBoundingClientRect();
        this.point(this.stage.hit(clientX - left, clientY - top));
      }
    });
    on("pointerleave", () => this.point(null));
    on("lostpointercapture", () => this.content().keep(this.view));
    on("wheel", (event) => turnAndKeep(event, zoomed(this.view, 1.001 ** -event.deltaY)));
    on("keydown", (event) => {
      const change = KEYS[event.key];
      if (change !== undefined && !event.ctrlKey && !event.metaKey && !event.altKey) {
        // The arrow keys also show moments of the past.
        event.stopPropagation();
        turnAndKeep(event, change(this.view));
      }
    });
  }
}

// The positions of a point of the box. A slice that shows a maximum has none on its axis.
function pointedAt({ axes, size }: SceneFrame, { point, slice }: Hit): ScenePosition {
  return axes.map(({ range: [lower, upper], along, folded }, d) =>
    along === undefined || (slice === d && folded === true)
      ? null
      : lower + ((point[d] as number) / (size[d] as number) + 0.5) * (upper - lower),
  );
}

// The positions of the cursor of another plot, where the box has its axes and contains them.
function linkedTo({ axes }: SceneFrame, coordinates: Coordinate[]): ScenePosition {
  return axes.map(({ range: [lower, upper], along }) => {
    const value = along === undefined ? null : valueOn(along, coordinates);
    return value === null || value < lower || value > upper ? null : value;
  });
}
