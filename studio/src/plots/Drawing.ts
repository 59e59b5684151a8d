// A plot on the page: canvases that fill a place, and above them the cursor, its own or that of another plot,
// with what lies there in words.

import type { Area, PlotLayout } from "../draw/axes";
import { canvasSettings } from "../draw/canvases";
import { colorsOf, type Content, type CurveLine, marksOf, rasterOf } from "../draw/content";
import { type Ink, isSmall } from "../draw/ink";
import { paintRaster } from "../draw/marks";
import { drawPlot } from "../draw/plot";
import { type At, nearestIndex, nearestPlace, nearestTime, readContent } from "../draw/cursorText";
import { shade } from "../model/colors";
import { pageInk } from "../widgets/look";
import { attachInjection } from "./injection/injection";
import { type Coordinate, linkedCursor, valueOn } from "./linked";
import type { Injection } from "./injection/spot";

type DrawingAsk = Readonly<{
  // What it shows, in words.
  label: () => string;
  // The input that a hand injects; null: the element takes none.
  injection: ((content: Content) => Injection | null) | null;
}>;

export class Drawing {
  // The inside, on which pointers act.
  readonly over = made("div", "plot-over");
  content: Content | null = null;
  private canvas = made("canvas", "plot-canvas");
  private image = made("canvas", "plot-heat");
  private words = made("div", "plot-readout numbers");
  private cross = { x: made("div", "plot-cursor-x"), y: made("div", "plot-cursor-y") };
  private strips = [made("div", "plot-axis"), made("div", "plot-axis")] as const;
  private dots: HTMLElement[] = [];
  private layout: PlotLayout | null = null;
  // The size of the place and the colours of the page, which cost a layout to read: not for each picture.
  private size = { width: 0, height: 0 };
  private ink: Ink | null = null;
  private drawn = "";
  // The pointer inside, in pixels of the page; null: it is elsewhere.
  private pointer: readonly [number, number] | null = null;
  private linked: At | null = null;
  private listening = new AbortController();
  private observer = new ResizeObserver(() => {
    this.measure();
    this.draw();
  });
  private ends: (() => void)[];

  constructor(
    readonly host: HTMLElement,
    private asked: DrawingAsk,
  ) {
    host.append(this.canvas, ...this.strips, this.over);
    this.over.append(this.cross.x, this.cross.y, this.words);
    const { signal } = this.listening;
    const move = ({ clientX, clientY }: PointerEvent) => {
      const { left, top } = this.over.getBoundingClientRect();
      this.point([clientX - left, clientY - top]);
    };
    this.over.addEventListener("pointerenter", move, { signal });
    this.over.addEventListener("pointermove", move, { signal });
    this.over.addEventListener("pointerleave", () => this.point(null), { signal });
    this.observer.observe(host);
    const { injection } = asked;
    this.ends = [
      linkedCursor.listen(this, (coordinates) => this.link(coordinates)),
      ...(injection === null
        ? []
        : [attachInjection(this, () => (this.content === null ? null : injection(this.content)))]),
    ];
    this.measure();
    this.name();
  }

  // Until there are other values the last ones stay.
  show(content: Content | null): void {
    this.content = content ?? this.content;
    this.draw();
    if (this.pointer !== null) {
      linkedCursor.point(this, this.coordinates());
    }
  }

  end(): void {
    this.point(null);
    this.listening.abort();
    this.observer.disconnect();
    for (const end of this.ends) {
      end();
    }
    this.host.replaceChildren();
    delete this.host.dataset["linked"];
  }

  // The values on both sides at a place inside, in pixels of the page, and the place of values.
  valuesAt([left, top]: readonly [number, number]): [number, number] {
    const { box, x, y } = this.layout ?? NOTHING;
    return [x.value(box.left + left * devicePixelRatio), y.value(box.top + top * devicePixelRatio)];
  }

  placeOf([across, up]: readonly [number, number]): [number, number] {
    const { box, x, y } = this.layout ?? NOTHING;
    return [(x.place(across) - box.left) / devicePixelRatio, (y.place(up) - box.top) / devicePixelRatio];
  }

  // The values at the pointer, or in the middle.
  pointed(): [number, number] {
    const { clientWidth, clientHeight } = this.over;
    return this.valuesAt(this.pointer ?? [clientWidth / 2, clientHeight / 2]);
  }

  private draw(): void {
    this.name();
    const { content, host, size } = this;
    if (content === null || size.width === 0 || size.height === 0) {
      return;
    }
    const ink = this.inkNow();
    const [width, height] = [Math.round(size.width * ink.unit), Math.round(size.height * ink.unit)];
    const still = stillOf(content, ink, width, height);
    if (still === null || still !== this.drawn) {
      this.drawn = still ?? "";
      this.redraw(content, ink, width, height);
    }
    const raster = rasterOf(content);
    if (raster === null) {
      this.image.remove();
    } else {
      if (!this.image.isConnected) {
        host.prepend(this.image);
      }
      const { width: across, height: down } = (this.layout ?? NOTHING).box;
      const size = { width: across / ink.unit, height: down / ink.unit };
      paintRaster(this.image, raster, content, { ...size, shade: ink.shade });
    }
    this.cursor();
  }

  private measure(): void {
    this.size = { width: this.host.clientWidth, height: this.host.clientHeight };
  }

  private inkNow(): Ink {
    const small = isSmall(this.size.width, this.size.height);
    const unit = devicePixelRatio;
    if (this.ink?.shade !== shade() || this.ink.small !== small || this.ink.unit !== unit) {
      this.ink = { ...pageInk(small), unit };
    }
    return this.ink;
  }

  private redraw(content: Content, ink: Ink, width: number, height: number): void {
    const { canvas } = this;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const ctx = canvas.getContext("2d", canvasSettings());
    if (ctx === null) {
      return;
    }
    ctx.clearRect(0, 0, width, height);
    this.layout = drawPlot({ ctx, ink, width, height }, content);
    for (const element of [this.over, this.image]) {
      put(element, this.layout.box);
    }
    this.strips.forEach((strip, i) => put(strip, (this.layout ?? NOTHING).strips[i as 0 | 1]));
  }

  private name(): void {
    const raster = this.content === null ? null : rasterOf(this.content);
    const [named, other] = raster?.type === "picture" ? [this.image, this.canvas] : [this.canvas, this.image];
    const label = this.asked.label();
    if (named.ariaLabel !== label || other.role !== null) {
      [named.role, named.ariaLabel] = ["img", label];
      [other.role, other.ariaLabel] = [null, null];
    }
  }

  // The values at the cursor; null: there is none.
  private at(): At | null {
    if (this.pointer === null) {
      return this.linked;
    }
    const [x, y] = this.valuesAt(this.pointer);
    return { x, y };
  }

  private point(now: readonly [number, number] | null): void {
    const before = this.pointer;
    this.pointer = now;
    if (now !== null) {
      this.linked = null;
    }
    if (now !== null || before !== null) {
      this.cursor();
    }
    if (now !== null) {
      linkedCursor.point(this, this.coordinates());
    } else if (before !== null) {
      linkedCursor.point(this, []);
    }
  }

  private coordinates(): Coordinate[] {
    const [content, at] = [this.content, this.at()];
    if (content === null || at === null || at.x === null || at.y === null) {
      return [];
    }
    const [tail] = marksOf(content, "tail");
    const i = tail === undefined ? -1 : nearestPlace(tail, [at.x, at.y], [content.x, content.y]);
    const time = tail?.times[i];
    return [
      { along: content.x.along, value: at.x },
      { along: content.y.along, value: at.y },
      ...(time === undefined ? [] : [{ along: "time" as const, value: time }]),
    ].filter(({ along }) => along !== null);
  }

  private link(coordinates: Coordinate[]): void {
    const { content } = this;
    if (content === null) {
      return;
    }
    const [tail] = marksOf(content, "tail");
    const time = tail === undefined ? null : valueOn("time", coordinates);
    if (tail !== undefined && time !== null) {
      const i = nearestTime(tail, time);
      this.linked = i < 0 ? null : { x: tail.xs[i] ?? null, y: tail.ys[i] ?? null };
    } else {
      const { x, y } = content;
      const [across, up] = [x, y].map(({ along, range: [lower, upper] }) => {
        const value = valueOn(along, coordinates);
        return value === null || value < lower || value > upper ? null : value;
      }) as [number | null, number | null];
      this.linked = across === null && up === null ? null : { x: across, y: up };
    }
    this.cursor();
  }

  // Draw the cursor, and say what lies there.
  private cursor(): void {
    const { content, host, cross } = this;
    const at = content === null || this.layout === null ? null : this.at();
    if (at === null || content === null) {
      delete host.dataset["linked"];
      [cross.x.hidden, cross.y.hidden] = [true, true];
      this.say("");
      this.mark([], 0);
      return;
    }
    if (this.pointer === null) {
      host.dataset["linked"] = `${at.x === null ? "" : "x"}${at.y === null ? "" : "y"}`;
    } else {
      delete host.dataset["linked"];
    }
    // The height in a plot of curves means nothing.
    const upright = content.y.along !== null || marksOf(content, "tail").length > 0;
    const [left, top] = this.placeOf([at.x ?? 0, at.y ?? 0]);
    [cross.x.hidden, cross.y.hidden] = [at.x === null, at.y === null || !upright];
    cross.x.style.transform = `translateX(${left}px)`;
    cross.y.style.transform = `translateY(${top}px)`;
    this.say(readContent(content, at));
    this.mark(at.x === null ? [] : marksOf(content, "line"), at.x ?? 0);
  }

  private say(words: string): void {
    if (this.words.textContent !== words) {
      this.words.textContent = words;
    }
  }

  // A dot on each curve at the cursor.
  private mark(lines: readonly CurveLine[], across: number): void {
    const { layout } = this;
    const places = lines.flatMap(({ xs, ys, right, color }) => {
      const i = nearestIndex(xs, across);
      const [x, y] = [xs[i], ys[i]];
      if (x === undefined || y == null || layout === null) {
        return [];
      }
      const up = right === true && layout.right !== null ? layout.right : layout.y;
      const top = (up.place(y) - layout.box.top) / devicePixelRatio;
      return [{ left: this.placeOf([x, 0])[0], top, color: color[shade()] }];
    });
    while (this.dots.length < places.length) {
      const dot = made("div", "plot-dot");
      this.over.append(dot);
      this.dots.push(dot);
    }
    this.dots.forEach((dot, i) => {
      const place = places[i];
      dot.hidden = place === undefined;
      if (place !== undefined) {
        dot.style.transform = `translate(${place.left}px, ${place.top}px)`;
        dot.style.background = place.color;
      }
    });
  }
}

const SAME = { place: () => 0, value: () => 0 };
const EMPTY: Area = { left: 0, top: 0, width: 0, height: 0 };
const NOTHING: PlotLayout = { box: EMPTY, x: SAME, y: SAME, right: null, strips: [EMPTY, EMPTY] };

function made<K extends keyof HTMLElementTagNameMap>(tag: K, className: string): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  element.className = className;
  return element;
}

function put({ style }: HTMLElement, { left, top, width, height }: Area): void {
  const sizes = { left, top, width, height };
  for (const [name, value] of Object.entries(sizes) as [keyof Area, number][]) {
    style[name] = `${value / devicePixelRatio}px`;
  }
}

// What a map shows beside its image: equal words, and nothing but the image has to be drawn. Null: the values
// are lines.
function stillOf(content: Content, ink: Ink, width: number, height: number): string | null {
  if (rasterOf(content) === null) {
    return null;
  }
  const { x, y, equal, marks } = content;
  const colors = colorsOf(content);
  const others = marks.map((mark) => (mark.type === "moment" ? mark.time : mark.type));
  const scale = colors && [colors.range, colors.middle, ...colors.tables[ink.shade].subarray(0, 4)];
  return JSON.stringify([x, y, equal, others, scale, ink, width, height]);
}
