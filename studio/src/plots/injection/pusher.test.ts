import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Pusher } from "./pusher";

let frame: (() => void) | null = null;

beforeEach(() => {
  vi.stubGlobal("requestAnimationFrame", (draw: () => void) => {
    frame = draw;
    return 1;
  });
  vi.stubGlobal("cancelAnimationFrame", () => (frame = null));
});

afterEach(() => vi.unstubAllGlobals());

const at = (place: number) => ({ center: [place], sigma: [1], amplitude: 5 });

it("an injection begins at once, follows the pointer once a frame, and ends once", () => {
  const sent: unknown[] = [];
  const pusher = new Pusher((message) => sent.push(message));
  pusher.release();
  pusher.push("a", at(1));
  pusher.push("a", at(2));
  pusher.push("a", at(3));
  expect(sent).toHaveLength(1);
  frame?.();
  expect(sent[1]).toEqual({ type: "push", element: "a", amplitude: 5, center: [3], sigma: [1] });
  pusher.push("a", at(4));
  pusher.release();
  pusher.release();
  frame?.();
  expect(sent.slice(2)).toEqual([{ type: "release" }]);
  expect(pusher.pushing).toBe(false);
});
