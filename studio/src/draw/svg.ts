// A drawing context that writes SVG: the part of a canvas context that charts use. Paths and texts stay
// vectors; a canvas that is drawn becomes an image inside the SVG.

type Matrix = readonly [number, number, number, number, number, number];

type PenState = {
  fillStyle: string;
  strokeStyle: string;
  lineWidth: number;
  lineCap: string;
  lineJoin: string;
  font: string;
  textAlign: string;
  textBaseline: string;
  globalAlpha: number;
  matrix: Matrix;
  dash: number[];
  // The id of the clip path, which contains the ones before it.
  clipped: string;
};

type ImageSource = { toDataURL: (type: string) => string };

const START: PenState = {
  fillStyle: "#000000",
  strokeStyle: "#000000",
  lineWidth: 1,
  lineCap: "butt",
  lineJoin: "miter",
  font: "10px sans-serif",
  textAlign: "start",
  textBaseline: "alphabetic",
  globalAlpha: 1,
  matrix: [1, 0, 0, 1, 0, 0],
  dash: [],
  clipped: "",
};

const ANCHORS: Record<string, string> = { center: "middle", right: "end", end: "end" };

// How far the baseline lies below the anchor of a text, in heights of the font. Programs that read SVG
// disagree about baselines, so that the position is computed.
const BASELINES: Record<string, number> = { top: 0.8, middle: 0.35, bottom: -0.2 };

export class SvgContext {
  fillStyle!: string;
  strokeStyle!: string;
  lineWidth!: number;
  lineCap!: string;
  lineJoin!: string;
  font!: string;
  textAlign!: string;
  textBaseline!: string;
  globalAlpha!: number;
  lineDashOffset = 0;
  imageSmoothingEnabled = true;

  private matrix!: Matrix;
  private dash!: number[];
  private clipped!: string;
  private saved: PenState[] = [];
  private path: string[] = [];
  private body: string[] = [];
  private clips = 0;

  constructor() {
    Object.assign(this, START);
  }

  // The elements drawn so far.
  get content(): string {
    return this.body.join("\n");
  }

  // A whole file, `scale` units of the drawing for each pixel of its size.
  document(width: number, height: number, scale: number): string {
    const size = `width="${short(width)}" height="${short(height)}"`;
    const box = `viewBox="0 0 ${short(width * scale)} ${short(height * scale)}"`;
    return `<svg xmlns="http://www.w3.org/2000/svg" ${size} ${box}>\n${this.content}\n</svg>\n`;
  }

  save(): void {
    const state = Object.keys(START).map((key) => [key, this[key as keyof SvgContext]]);
    this.saved.push(Object.fromEntries(state) as PenState);
  }

  restore(): void {
    Object.assign(this, this.saved.pop());
  }

  // Charts clear before they draw everything again.
  clearRect(): void {
    this.body = [];
  }

  setLineDash(dash: number[]): void {
    this.dash = [...dash];
  }

  translate(x: number, y: number): void {
    this.transform([1, 0, 0, 1, x, y]);
  }

  rotate(angle: number): void {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    this.transform([c, s, -s, c, 0, 0]);
  }

  beginPath(): void {
    this.path = [];
  }

  moveTo(x: number, y: number): void {
    this.path.push(`M${short(x)} ${short(y)}`);
  }

  lineTo(x: number, y: number): void {
    this.path.push(`${this.path.length === 0 ? "M" : "L"}${short(x)} ${short(y)}`);
  }

  rect(x: number, y: number, width: number, height: number): void {
    this.path.push(`M${short(x)} ${short(y)}h${short(width)}v${short(height)}h${short(-width)}Z`);
  }

  // Charts draw whole circles only.
  arc(x: number, y: number, radius: number): void {
    const [r, across] = [short(radius), short(2 * radius)];
    this.path.push(
      `M${short(x - radius)} ${short(y)}a${r} ${r} 0 1 0 ${across} 0a${r} ${r} 0 1 0 -${across} 0Z`,
    );
  }

  closePath(): void {
    this.path.push("Z");
  }

  stroke(): void {
    const width = `stroke-width="${short(this.lineWidth)}"`;
    const ends = `stroke-linecap="${this.lineCap}" stroke-linejoin="${this.lineJoin}"`;
    const dash = this.dash.length === 0 ? "" : ` stroke-dasharray="${this.dash.map(short).join(" ")}"`;
    this.draw(`fill="none" stroke="${escaped(this.strokeStyle)}" ${width} ${ends}${dash}`);
  }

  fill(): void {
    this.draw(`fill="${escaped(this.fillStyle)}"`);
  }

  strokeRect(x: number, y: number, width: number, height: number): void {
    this.beginPath();
    this.rect(x, y, width, height);
    this.stroke();
  }

  fillRect(x: number, y: number, width: number, height: number): void {
    this.beginPath();
    this.rect(x, y, width, height);
    this.fill();
  }

  clip(): void {
    const id = `clip-${++this.clips}`;
    this.body.push(`<clipPath id="${id}"><path d="${this.path.join("")}"${this.placing()}/></clipPath>`);
    this.clipped = id;
  }

  fillText(text: string, x: number, y: number): void {
    const [, weight = "400", size = "10", family = "sans-serif"] =
      /^(?:(\S+) )?([\d.]+)px (.*)$/.exec(this.font) ?? [];
    const down = y + (BASELINES[this.textBaseline] ?? 0) * Number(size);
    const font = `font-family="${escaped(family)}" font-size="${size}" font-weight="${weight}"`;
    const anchor = `text-anchor="${ANCHORS[this.textAlign] ?? "start"}"`;
    const place = `x="${short(x)}" y="${short(down)}"`;
    const style = `${anchor} ${font} fill="${escaped(this.fillStyle)}"${this.general()}`;
    this.add(`<text ${place} ${style}>${escaped(text)}</text>`);
  }

  drawImage(image: ImageSource, x: number, y: number, width: number, height: number): void {
    const place = `x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${short(height)}"`;
    const sharp = this.imageSmoothingEnabled ? "" : ' style="image-rendering: pixelated"';
    const content = `href="${image.toDataURL("image/png")}" preserveAspectRatio="none"`;
    this.add(`<image ${place} ${content}${sharp}${this.general()}/>`);
  }

  private draw(style: string): void {
    if (this.path.length > 0) {
      this.add(`<path d="${this.path.join("")}" ${style}${this.general()}/>`);
    }
  }

  // The clip path is that of a group around the element, whose transformation it does not share.
  private add(element: string): void {
    this.body.push(this.clipped === "" ? element : `<g clip-path="url(#${this.clipped})">${element}</g>`);
  }

  private general(): string {
    const faint = this.globalAlpha === 1 ? "" : ` opacity="${short(this.globalAlpha)}"`;
    return `${faint}${this.placing()}`;
  }

  private placing(): string {
    const { matrix } = this;
    const moved = matrix.some((value, i) => value !== START.matrix[i]);
    return moved ? ` transform="matrix(${matrix.map(short).join(" ")})"` : "";
  }

  private transform([a, b, c, d, e, f]: Matrix): void {
    const [A, B, C, D, E, F] = this.matrix;
    this.matrix = [
      A * a + C * b,
      B * a + D * b,
      A * c + C * d,
      B * c + D * d,
      A * e + C * f + E,
      B * e + D * f + F,
    ];
  }
}

function short(value: number): string {
  return String(Number(value.toFixed(3)));
}

function escaped(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
}
