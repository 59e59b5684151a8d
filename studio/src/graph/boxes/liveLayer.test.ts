import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { LiveLayer } from "./liveLayer";

type DrawnPicture = [picture: unknown, x: number, y: number, width: number, height: number];

let frames: (() => void)[] = [];
const next = () => frames.splice(0).forEach((frame) => frame());

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("window", { devicePixelRatio: 1, setTimeout, clearTimeout });
  vi.stubGlobal("document", { createElement: () => ({ getContext: () => null }) });
  vi.stubGlobal("requestAnimationFrame", (frame: () => void) => frames.push(frame));
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      disconnect() {}
    },
  );
});
afterEach(() => {
  frames = [];
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

const rect = (left: number, top: number, width: number, height: number) => ({
  left,
  top,
  width,
  height,
  right: left + width,
  bottom: top + height,
});
const slot = (left: number, top: number) =>
  ({ closest: () => null, getBoundingClientRect: () => rect(left, top, 100, 50) }) as unknown as HTMLElement;
const picture = (style = {}) => ({ width: 100, height: 100, style }) as unknown as HTMLCanvasElement;

function stage() {
  const drawn: DrawnPicture[] = [];
  const ctx = {
    setTransform: () => {},
    clearRect: () => drawn.splice(0),
    drawImage: (...given: DrawnPicture) => drawn.push(given),
    imageSmoothingEnabled: true,
  };
  const canvas = {
    width: 0,
    height: 0,
    style: { transform: "" },
    getBoundingClientRect: () => rect(10, 20, 400, 300),
    getContext: () => ctx,
  };
  const layer = new LiveLayer();
  layer.attach(canvas as unknown as HTMLCanvasElement);
  return { layer, canvas, drawn };
}

test("pictures are drawn at the positions of their boxes, unless they are out of sight", () => {
  const { layer, canvas, drawn } = stage();
  const near = picture();
  layer.add(slot(110, 70), near);
  layer.add(slot(900, 70), picture());
  next();
  expect(drawn).toEqual([[near, 100, 50, 100, 50]]);
  expect([canvas.width, canvas.height]).toEqual([400, 300]);
});

test("a picture that keeps its aspect ratio is centred", () => {
  const { layer, drawn } = stage();
  layer.add(slot(10, 20), picture({ objectFit: "contain" }));
  next();
  expect(drawn[0]?.slice(1)).toEqual([25, 0, 50, 50]);
});

test("a removed picture is not drawn", () => {
  const { layer, drawn } = stage();
  const place = slot(110, 70);
  layer.add(place, picture());
  layer.remove(place);
  next();
  expect(drawn).toEqual([]);
});

test("what is drawn during a move is painted for the present view", () => {
  const { layer, canvas, drawn } = stage();
  layer.add(slot(110, 70), picture());
  next();
  layer.move({ x: 0, y: 0, zoom: 1 });
  layer.move({ x: 30, y: 0, zoom: 1 });
  drawn.splice(0);
  layer.paint();
  expect(drawn).toHaveLength(1);
  expect(canvas.style.transform).toBe("");
  layer.move({ x: 35, y: 0, zoom: 1 });
  expect(canvas.style.transform, "from there").toBe("translate(5px, 0px) scale(1)");
});

test("a moved view moves the layer unchanged; the layer is painted again at the end of the move", () => {
  const { layer, canvas, drawn } = stage();
  layer.add(slot(110, 70), picture());
  layer.move({ x: 0, y: 0, zoom: 1 });
  layer.move({ x: 30, y: -10, zoom: 2 });
  next();
  expect(drawn).toEqual([]);
  expect(canvas.style.transform).toBe("translate(30px, -10px) scale(2)");
  vi.runAllTimers(); // no message reported the end
  next();
  expect(canvas.style.transform).toBe("");
  expect(drawn).toHaveLength(1);
});
