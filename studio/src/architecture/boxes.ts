// The box of an element: its size, its content and the positions of its ports.

import type { ElementView } from "../protocol";
import type { Size } from "../model/rects";

// `widest`: the width of a box whose name needs it; `letter`: the width of a letter of a name, about.
export const BOX = { width: 156, widest: 176, letter: 7.4, title: 40, port: 24, pad: 8, pin: 24 };
// Samples along each axis of a map.
const MOST_CELLS = 64;
// `small` is the width of a live picture in a box that shows its name and little else.
export const LIVE = { width: BOX.width - 2 * BOX.pad, curve: 56, number: 20, small: 84 };

// The port whose values the box shows.
export function livePort(element: ElementView): string | null {
  return element.outputs.includes("activation") ? "activation" : (element.outputs[0] ?? null);
}

// In a record without that port, a recorded one of the same shape takes its place.
export function shownPort(element: ElementView | undefined, recorded?: string[]): string | null {
  const port = element === undefined ? null : livePort(element);
  if (element === undefined || port === null || recorded === undefined || recorded.includes(port)) {
    return port;
  }
  return recorded.find((other) => same(element.axes[other], element.axes[port])) ?? port;
}

function same(one: string[] | undefined, other: string[] | undefined): boolean {
  return one?.join() === other?.join();
}

// The number of axes of the port that the box shows; null as long as they are not known.
export function dimensions(element: ElementView): number | null {
  return element.axes[livePort(element) ?? ""]?.length ?? null;
}

export function dimensionsText(n: number): string {
  return n === 1 ? "1 dimension" : `${n} dimensions`;
}

// The height of the live picture: a number needs less than a curve; an unknown content gets the full height.
export function liveHeight(element: ElementView): number {
  const port = livePort(element);
  return port === null ? 0 : dimensions(element) === 0 ? LIVE.number : LIVE.curve;
}

// The samples along an axis for which a live picture has room: a curve has two for each of its pixels, which
// a view that is magnified shows.
export function mostSamples(axes: number, width: number): number {
  return axes === 1 ? 2 * width : MOST_CELLS;
}

// `pins`: the number of sliders below the live picture.
export function boxSize(element: ElementView, pins = 0): Size {
  const live = liveHeight(element);
  const ports = Math.max(element.inputs.length, element.outputs.length);
  const content = live + BOX.pin * pins;
  return {
    width: Math.max(BOX.width, Math.min(BOX.widest, Math.ceil(BOX.letter * element.name.length) + 20)),
    height: Math.max(BOX.title + (content === 0 ? 0 : content + BOX.pad), BOX.port * (ports + 1)),
  };
}

// The height of the n-th of `count` ports of one side.
export function portHeight(height: number, n: number, of: number): number {
  return Math.round((height * (n + 1)) / (of + 1));
}
