// A scene in three dimensions that fills its place: the frame on one canvas, and above it what three.js
// draws. The pointer and the arrow keys turn it, the wheel and + and - magnify it. The cursor of all plots is
// lines on it: what lies under the pointer, or where the pointer in another plot is.

import { useComputedColorScheme } from "@mantine/core";
import { type RefObject, useEffect, useRef, useState } from "react";
import type { ListedProblem } from "../../protocol";
import { type DrawingFormat, exportScene } from "../export/exportDrawing";
import { type Coordinate, linkedCursor, valueOn } from "../linked";
import { pageInk } from "../colors/look";
import { drawSceneFrame, type SceneFrame } from "./sceneFrame";
import { FIRST_VIEW, turned, type Viewpoint, zoomed } from "./sceneView";
import type { Hit, SceneStage } from "./sceneStage";
import { useLatest } from "../useLatest";

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

const NO_WEBGL: ListedProblem = {
  what: "This browser has no WebGL, which plots in three dimensions need.",
  fix: 'Choose "Heat map" under "Show as", or allow WebGL in the settings of the browser.',
};

const KEYS: Record<string, (view: Viewpoint) => Viewpoint> = {
  ArrowLeft: (view) => turned(view, -20, 0),
  ArrowRight: (view) => turned(view, 20, 0),
  ArrowUp: (view) => turned(view, 0, -20),
  ArrowDown: (view) => turned(view, 0, 20),
  "+": (view) => zoomed(view, 1.15),
  "-": (view) => zoomed(view, 1 / 1.15),
};

export function useScene(made: SceneContent): SceneRefs {
  const host = useRef<HTMLDivElement>(null);
  const scene = useRef<LiveScene | null>(null);
  const latest = useLatest(made);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });

  useEffect(() => {
    const place = host.current;
    if (place === null) {
      return;
    }
    let ended = false;
    const begin = async () => {
      if (document.createElement("canvas").getContext("webgl2") === null) {
        setProblem(NO_WEBGL);
        return;
      }
      const { SceneStage: Made } = await import("./sceneStage");
      if (!ended) {
        scene.current = new LiveScene(
          place,
          (canvas) => new Made(canvas),
          () => latest.current,
        );
        scene.current.redraw();
      }
    };
    begin().catch((error: unknown) => {
      console.error(error);
      setProblem({ ...NO_WEBGL, what: error instanceof Error ? error.message : String(error) });
    });
    return () => {
      ended = true;
      scene.current?.end();
      scene.current = null;
    };
  }, [latest]);
  useEffect(() => scene.current?.redraw(), [scheme, made.label]);

  return {
    host,
    redraw: () => scene.current?.redraw(),
    problem,
    exportAs: (title, format) => scene.current?.export(title, format),
  };
}

class LiveScene {
  private stage: SceneStage;
  private below = document.createElement("canvas");
  private above = document.createElement("canvas");
  private words = document.createElement("div");
  private frame: SceneFrame | null = null;
  private pointed: Hit | null = null;
  private linked: Coordinate[] = [];
  private unlink: () => void;
  private view: Viewpoint;
  private due = 0;
  private listening = new AbortController();
  private observer = new ResizeObserver(() => this.redraw());

  constructor(
    private host: HTMLElement,
    make: (canvas: HTMLCanvasElement) => SceneStage,
    private content: () => SceneContent,
  ) {
    for (const canvas of [this.below, this.above]) {
      canvas.className = "plot-scene";
      host.append(canvas);
    }
    this.words.className = "plot-readout numbers";
    host.append(this.words);
    this.above.setAttribute("role", "img");
    this.stage = make(this.above);
    this.view = content().view ?? FIRST_VIEW;
    this.observer.observe(host);
    this.unlink = linkedCursor.listen(this, (coordinates) => {
      this.linked = coordinates;
      this.redraw();
    });
    this.listen();
  }

  // Draw with the next picture of the browser.
  redraw(): void {
    this.due ||= requestAnimationFrame(() => this.draw());
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
    cancelAnimationFrame(this.due);
    this.listening.abort();
    this.observer.disconnect();
    this.stage.end();
    this.below.remove();
    this.above.remove();
    this.words.remove();
    delete this.host.dataset["linked"];
  }

  private draw(): void {
    this.due = 0;
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
    const { signal } = this.listening;
    const { host } = this;
    host.addEventListener(
      "pointerdown",
      (event) => event.button === 0 && host.setPointerCapture(event.pointerId),
      {
        signal,
      },
    );
    host.addEventListener(
      "pointermove",
      ({ pointerId, movementX, movementY, clientX, clientY }) => {
        if (host.hasPointerCapture(pointerId)) {
          this.point(null);
          this.turn(turned(this.view, movementX, movementY));
        } else {
          const { left, top, width, height } = host.getBoundingClientRect();
          this.point(this.stage.hit(clientX - left, clientY - top, width, height));
        }
      },
      { signal },
    );
    host.addEventListener("pointerleave", () => this.point(null), { signal });
    host.addEventListener("lostpointercapture", () => this.content().keep(this.view), { signal });
    host.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.turn(zoomed(this.view, 1.001 ** -event.deltaY));
        this.content().keep(this.view);
      },
      { signal, passive: false },
    );
    host.addEventListener(
      "keydown",
      (event) => {
        const change = KEYS[event.key];
        if (change !== undefined && !event.ctrlKey && !event.metaKey && !event.altKey) {
          event.preventDefault();
          // The arrow keys also show moments of the past.
          event.stopPropagation();
          this.turn(change(this.view));
          this.content().keep(this.view);
        }
      },
      { signal },
    );
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
