// Colours of plots. Every scale is monotone in lightness or has its turning point at 0, so that it reads
// without hues too.

export type ScaleName = "cividis" | "viridis" | "diverging" | "gray";

// 256 colours of 4 bytes (red, green, blue, opaque).
export type Scale = Uint8ClampedArray;

const ANCHORS: Record<ScaleName, string[]> = {
  cividis: [
    "#00224e",
    "#123570",
    "#3b496c",
    "#575d6d",
    "#707173",
    "#8a8678",
    "#a59c74",
    "#c3b369",
    "#e1cc55",
    "#fee838",
  ],
  viridis: [
    "#440154",
    "#482878",
    "#3e4989",
    "#31688e",
    "#26828e",
    "#1f9e89",
    "#35b779",
    "#6ece58",
    "#b5de2b",
    "#fde725",
  ],
  diverging: [
    "#053061",
    "#2166ac",
    "#4393c3",
    "#92c5de",
    "#d1e5f0",
    "#f7f7f7",
    "#fddbc7",
    "#f4a582",
    "#d6604d",
    "#b2182b",
    "#67001f",
  ],
  gray: ["#000000", "#ffffff"],
};

export const SCALES: { name: ScaleName; label: string }[] = [
  { name: "viridis", label: "Violet to yellow" },
  { name: "cividis", label: "Blue to yellow" },
  { name: "diverging", label: "Blue to red, white at 0" },
  { name: "gray", label: "Black to white" },
];

const made = new Map<ScaleName, Scale>();

export function scale(name: ScaleName): Scale {
  let table = made.get(name);
  if (table === undefined) {
    table = interpolated(ANCHORS[name].map(parts));
    made.set(name, table);
  }
  return table;
}

// The scale for values on both sides of 0 and the one for values on one side.
export const sequential = scale("viridis");
export const diverging = scale("diverging");

// Okabe and Ito's colours, with the two that vanish on white or on black exchanged for their neighbours.
const CURVES = {
  light: ["#0072b2", "#d55e00", "#007f5f", "#b0568c", "#a66f00", "#2a8fc4", "#1a1a1a"],
  dark: ["#56b4e9", "#f0793a", "#1fbf92", "#e29ac4", "#e6a817", "#8fd0f5", "#f0e442"],
};

export type Shade = keyof typeof CURVES;

// The n-th colour of a set of curves.
export function curveColor(n: number, shade: Shade): string {
  const colors = CURVES[shade];
  return colors[n % colors.length] ?? "#808080";
}

// The colours of a field and of a level, in every box and plot. The light ones are those of
// `dd.figures.COLOR`, and theme.css has both: a test compares all three.
export const FIELD_COLORS = {
  light: {
    activation: "#0072b2",
    output: "#009e73",
    input: "#bf7f00",
    interaction: "#b0568c",
    level: "#555555",
  },
  dark: {
    activation: "#56b4e9",
    output: "#1fbf92",
    input: "#e6a817",
    interaction: "#e29ac4",
    level: "#9faaa4",
  },
} as const;

// Ports of other names follow in order.
const FIRST_PORTS = ["activation", "output", "input", "interaction"] as const;
type FirstPort = (typeof FIRST_PORTS)[number];
const isFirst = (port: string): port is FirstPort => FIRST_PORTS.some((known) => known === port);

export function inOrder(ports: string[]): string[] {
  return [...FIRST_PORTS.filter((port) => ports.includes(port)), ...ports.filter((port) => !isFirst(port))];
}

export function portColor(port: string, ports: string[], shade: Shade): string {
  if (isFirst(port)) {
    return FIELD_COLORS[shade][port];
  }
  const others = ports.filter((other) => !isFirst(other));
  return curveColor(FIRST_PORTS.length + Math.max(0, others.indexOf(port)), shade);
}

// Whether the page is dark at present.
export function shade(): Shade {
  return document.documentElement.dataset["mantineColorScheme"] === "dark" ? "dark" : "light";
}

// The piece of a two-sided scale that belongs to a range: its middle is at `middle`, and equal steps are
// equal changes of colour on both sides of it.
export function centred(table: Scale, lower: number, upper: number, middle: number): Scale {
  const reach = Math.max(upper - middle, middle - lower);
  const piece = new Uint8ClampedArray(4 * 256);
  for (let i = 0; i < 256; i++) {
    const value = lower + (i / 255) * (upper - lower);
    const from =
      4 * Math.min(255, Math.max(0, Math.round(127.5 + (127.5 * (value - middle)) / (reach || 1))));
    piece.set(table.subarray(from, from + 4), 4 * i);
  }
  return piece;
}

function interpolated(anchors: number[][]): Scale {
  const table = new Uint8ClampedArray(4 * 256);
  for (let i = 0; i < 256; i++) {
    const place = (i / 255) * (anchors.length - 1);
    const left = Math.min(Math.floor(place), anchors.length - 2);
    const share = place - left;
    for (let c = 0; c < 3; c++) {
      table[4 * i + c] = (anchors[left]?.[c] ?? 0) * (1 - share) + (anchors[left + 1]?.[c] ?? 0) * share;
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

function parts(color: string): number[] {
  return [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
}
