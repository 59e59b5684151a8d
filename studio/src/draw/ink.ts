// The colours and sizes of a drawing, on the page or on paper.

// The typeface of the page, its canvases and its exported pictures. Where a picture is opened without it, the
// sans serif of the system has the names.
export const TYPEFACE = '"Inter Variable", Inter, system-ui, sans-serif';

export type Shade = "light" | "dark";

// A colour on a light and on a dark ground.
export type Paint = Readonly<Record<Shade, string>>;

export type Ink = Readonly<{
  shade: Shade;
  text: string;
  dim: string;
  grid: string;
  ground: string;
  // All lengths are multiples of this: the pixels of a canvas for each pixel of the page.
  unit: number;
  // Whether the drawing is so small that it has numbers at its axes only.
  small: boolean;
}>;

// Below these sizes, in pixels of the page, names of axes and colour bars would leave no room for the values.
const SMALL = { width: 240, height: 130 };

export function isSmall(width: number, height: number): boolean {
  return width < SMALL.width || height < SMALL.height;
}

export function font(ink: Pick<Ink, "unit">, size = 11): string {
  return `${size * ink.unit}px ${TYPEFACE}`;
}

export function paperInk(unit: number, small = false): Ink {
  const colors = { text: "#111111", dim: "#444444", grid: "#e6e6e6", ground: "#ffffff" };
  return { shade: "light", ...colors, unit, small };
}

type LineEnds = readonly [x1: number, y1: number, x2: number, y2: number];

// Straight lines, in one path.
export function strokeLines(
  ctx: Pick<CanvasRenderingContext2D, "beginPath" | "moveTo" | "lineTo" | "stroke">,
  ...lines: readonly LineEnds[]
): void {
  ctx.beginPath();
  for (const [x1, y1, x2, y2] of lines) {
    ctx.moveTo(x1, y1);
    ctx.lineTo(x2, y2);
  }
  ctx.stroke();
}

// About how wide a text is, in heights of its font: a drawing is laid out without a canvas.
const LETTER = 0.58;

export function widthOf(text: string, size: number): number {
  return LETTER * size * text.length;
}

// The text, cut where it is wider than a room.
export function fitting(text: string, size: number, room: number): string {
  const most = Math.floor(room / (LETTER * size));
  return text.length <= most ? text : most < 2 ? "" : `${text.slice(0, most - 1)}…`;
}
