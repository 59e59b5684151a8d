// A uPlot that fills its place, follows the size and the colours of the page, and reports what lies under the
// cursor, its own or that of another chart.

import { useComputedColorScheme } from "@mantine/core";
import { type RefObject, useEffect, useRef, useState } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { canvasSettings } from "../../canvases";
import { ChartCursor, type CursorAt, type Orbit } from "./chartCursor";
import type { Along } from "../linked";
import { isSmall, type Look, pageLook } from "../colors/look";
import { useLatest } from "../useLatest";

export type ChartOptions = Omit<uPlot.Options, "width" | "height"> & {
  hooks?: Pick<uPlot.Hooks.Arrays, "draw">;
};

export type Chart = {
  // Made again when the key or the colours change.
  options: (look: Look) => ChartOptions;
  // What is drawn at first; afterwards it is set from outside.
  data: () => uPlot.AlignedData;
  // The extents of both scales, if they have the same scale.
  extents?: [number, number] | null;
  // What it shows, in words.
  label: string;
  // What its scales show, for the linked cursor.
  along?: { x: Along; y?: Along };
  // A course through its plane, for the time of the linked cursor.
  orbit?: Orbit;
  // What lies at the cursor, in words.
  read?: (chart: uPlot, at: CursorAt) => string;
  // Adds other content to the chart; returns a function that removes it.
  attach?: (chart: uPlot, look: Look) => () => void;
};

export type ChartRefs = {
  host: RefObject<HTMLDivElement | null>;
  chart: RefObject<uPlot | null>;
  // Report what lies at the cursor: the values under it changed.
  reread: () => void;
};

const LEAST = 40;

// How often a size is corrected for the same scale on both axes: labels take another room in each size.
const TRIES = 3;

export function useChart(made: Chart, key: string): ChartRefs {
  const host = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot | null>(null);
  const readout = useRef<HTMLDivElement | null>(null);
  const cursor = useRef<ChartCursor | null>(null);
  const latest = useLatest(made);
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });
  // A chart that gets small, or large again, is made again.
  const [remade, setRemade] = useState(0);

  const read = (self: uPlot) => {
    if (readout.current !== null) {
      const at = cursor.current?.at() ?? null;
      readout.current.textContent = at === null ? "" : (latest.current.read?.(self, at) ?? "");
    }
  };

  useEffect(() => {
    const place = host.current;
    if (place === null) {
      return;
    }
    const look = pageLook(isSmallIn(place));
    const current = latest.current;
    const options = current.options(look);
    let tries = 0;
    const fit = (self: uPlot) => {
      const size = fitted(self, place, latest.current.extents ?? null);
      if (size !== null && tries < TRIES) {
        tries++;
        // Not while it draws.
        queueMicrotask(() => chart.current === self && self.setSize(size));
      }
    };
    const moved = (self: uPlot) => {
      read(self);
      cursor.current?.tell();
    };
    const hooks = {
      draw: [...(options.hooks?.draw ?? []), fit, () => cursor.current?.follow()],
      setCursor: [moved],
    };
    const whole = { ...options, hooks, ...sizeOf(place) };
    const created = onProcessor(() => new uPlot(whole, current.data(), place));
    const words = document.createElement("div");
    words.className = "plot-readout numbers";
    created.over.append(words);
    readout.current = words;
    const pointer = new ChartCursor(created, place, () => latest.current);
    cursor.current = pointer;
    created.ctx.canvas.setAttribute("role", "img");
    created.ctx.canvas.setAttribute("aria-label", current.label);
    const detach = current.attach?.(created, look);
    let room = sizeOf(place);
    const observer = new ResizeObserver(() => {
      const size = sizeOf(place);
      if (place.clientWidth > 0 && (size.width !== room.width || size.height !== room.height)) {
        room = size;
        tries = 0;
        created.setSize(size);
        if (isSmallIn(place) !== look.small) {
          setRemade((count) => count + 1);
        }
      }
    });
    observer.observe(place);
    chart.current = created;
    return () => {
      observer.disconnect();
      pointer.end();
      cursor.current = null;
      detach?.();
      created.destroy();
      chart.current = null;
    };
  }, [key, scheme, remade, latest]);

  return { host, chart, reread: () => chart.current !== null && read(chart.current) };
}

function sizeOf(place: HTMLElement): { width: number; height: number } {
  return { width: Math.max(LEAST, place.clientWidth), height: Math.max(LEAST, place.clientHeight) };
}

// A hidden place has no size.
function isSmallIn({ clientWidth, clientHeight }: HTMLElement): boolean {
  return clientWidth > 0 && isSmall(clientWidth, clientHeight);
}

// The size in which both axes have the same scale; null: the chart has it.
function fitted(
  chart: uPlot,
  place: HTMLElement,
  extents: [number, number] | null,
): { width: number; height: number } | null {
  if (extents === null) {
    return null;
  }
  const { width, height } = sizeOf(place);
  const inner = { width: chart.bbox.width / devicePixelRatio, height: chart.bbox.height / devicePixelRatio };
  const around = { width: chart.width - inner.width, height: chart.height - inner.height };
  const scale = Math.min((width - around.width) / extents[0], (height - around.height) / extents[1]);
  const size = {
    width: Math.round(around.width + scale * extents[0]),
    height: Math.round(around.height + scale * extents[1]),
  };
  const near = Math.abs(size.width - chart.width) <= 1 && Math.abs(size.height - chart.height) <= 1;
  return near || scale <= 0 ? null : size;
}

// uPlot asks for its canvas while it is made and has no option for its settings, which only matter where the
// processor draws.
function onProcessor<T>(make: () => T): T {
  const settings = canvasSettings();
  if (settings.willReadFrequently !== true) {
    return make();
  }
  const asked = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string) {
    return asked.call(this, kind, settings);
  } as typeof asked;
  try {
    return make();
  } finally {
    HTMLCanvasElement.prototype.getContext = asked;
  }
}
