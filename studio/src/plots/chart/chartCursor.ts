// The cursor of a chart: the mouse pointer in it, or the coordinates of the pointer in another chart.

import type uPlot from "uplot";
import { type Along, type Coordinate, linkedCursor, valueOn } from "../linked";

// Values on the scales at the cursor. Where the cursor is in another chart, one of them may be unknown.
export type CursorAt = { x: number | null; y: number | null };

// A course through the plane of a chart: the place at a time, and the time of the nearest place.
export type Orbit = {
  at: (time: number) => readonly [x: number, y: number] | null;
  time: (x: number, y: number) => number | null;
};

type Linkable = { along?: { x: Along; y?: Along }; orbit?: Orbit };

// Where uPlot draws no cursor.
const NOWHERE = -10;

const NOTHING: { x: Along; y?: Along } = { x: null };

export class ChartCursor {
  private inside = false;
  private linked: CursorAt | null = null;
  private listening = new AbortController();
  private unlink: () => void;

  constructor(
    private chart: uPlot,
    private host: HTMLElement,
    private linkable: () => Linkable,
  ) {
    const { signal } = this.listening;
    chart.over.addEventListener("mouseenter", () => this.enter(true), { signal });
    chart.over.addEventListener("mouseleave", () => this.enter(false), { signal });
    this.unlink = linkedCursor.listen(this, (coordinates) => this.link(coordinates));
  }

  // The values at the cursor; null: there is none.
  at(): CursorAt | null {
    const { left = -1, top = -1 } = this.chart.cursor;
    if (this.linked !== null) {
      return this.linked;
    }
    return left < 0
      ? null
      : { x: this.chart.posToVal(left, "x"), y: this.chart.posToVal(top, this.upright()) };
  }

  // Pass on what the pointer in this chart points at.
  tell(): void {
    if (this.inside) {
      const at = this.at();
      const { along: { x, y = null } = NOTHING, orbit } = this.linkable();
      const time = at === null || at.x === null || at.y === null ? null : orbit?.time(at.x, at.y);
      const coordinates = at === null ? [] : coordinatesOf([x, at.x], [y, at.y], ["time", time ?? null]);
      linkedCursor.point(this, coordinates);
    }
  }

  // Keep the cursor of another chart at its values while the scales change.
  follow(): void {
    if (this.linked === null) {
      return;
    }
    const { x, y } = this.linked;
    const { clientWidth, clientHeight } = this.chart.over;
    const left = x === null ? NOWHERE : within(this.chart.valToPos(x, "x"), clientWidth);
    const top = y === null ? NOWHERE : within(this.chart.valToPos(y, this.upright()), clientHeight);
    if (left !== this.chart.cursor.left || top !== this.chart.cursor.top) {
      this.chart.setCursor({ left, top });
    }
  }

  end(): void {
    this.enter(false);
    this.listening.abort();
    this.unlink();
  }

  private enter(inside: boolean): void {
    if (this.inside && !inside) {
      linkedCursor.point(this, []);
    }
    this.inside = inside;
    if (inside) {
      this.show(null);
    }
  }

  private link(coordinates: Coordinate[]): void {
    const { along: { x: across, y: up = null } = NOTHING, orbit } = this.linkable();
    const time = orbit === undefined ? null : valueOn("time", coordinates);
    const place = time === null ? null : (orbit?.at(time) ?? null);
    if (place !== null) {
      this.show({ x: place[0], y: place[1] });
      return;
    }
    const { clientWidth, clientHeight } = this.chart.over;
    const seen = (along: Along, scale: string, room: number) => {
      const value = valueOn(along, coordinates);
      const place = value === null ? NOWHERE : within(this.chart.valToPos(value, scale), room);
      return place === NOWHERE ? null : value;
    };
    const x = seen(across, "x", clientWidth);
    const y = seen(up, this.upright(), clientHeight);
    this.show(x === null && y === null ? null : { x, y });
  }

  private show(linked: CursorAt | null): void {
    const before = this.linked;
    this.linked = linked;
    if (linked !== null) {
      this.host.dataset["linked"] = `${linked.x === null ? "" : "x"}${linked.y === null ? "" : "y"}`;
      this.follow();
    } else if (before !== null) {
      delete this.host.dataset["linked"];
      this.chart.setCursor({ left: NOWHERE, top: NOWHERE });
    }
  }

  private upright(): string {
    return Object.keys(this.chart.scales).find((scale) => scale !== "x") ?? "y";
  }
}

function coordinatesOf(...pairs: [Along, number | null][]): Coordinate[] {
  return pairs.flatMap(([along, value]) => (along === null || value === null ? [] : [{ along, value }]));
}

// A position that the plot does not show is nowhere.
function within(place: number, room: number): number {
  return place >= 0 && place <= room ? place : NOWHERE;
}
