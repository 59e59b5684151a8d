/** What can be read on the canvas: names in their boxes, boxes and wires beside each other. */
import type { Page } from "playwright-core";

import { panel } from "./hands";

/** Names below this size, in px of the screen, are not read. */
export const SMALLEST = 11;

/** Names of boxes that are too small, leave their box, or cover a part of another name. */
export const misplacedNames = (page: Page): Promise<string[]> =>
  panel(page, "Architecture")
    .locator(".graph-box, .graph-folded")
    .evaluateAll((boxes, smallest) => {
      const names = boxes.flatMap((box) => {
        const name = box.querySelector<HTMLElement>(".graph-box-name");
        const rect = name?.getBoundingClientRect();
        if (name === null || rect === undefined || rect.width === 0) return [];
        const viewport = box.closest(".react-flow__viewport") as HTMLElement;
        const zoom = new DOMMatrix(getComputedStyle(viewport).transform).a;
        const size = zoom * Number.parseFloat(getComputedStyle(name).fontSize);
        const frame = box.getBoundingClientRect();
        const shown = getComputedStyle(name).overflow === "visible" ? textOf(name) : rect;
        return [{ text: name.textContent ?? "", size, rect: shown, frame }];
      });
      return names.flatMap(({ text, size, rect, frame }, i) => {
        const out =
          rect.left < frame.left - 1 ||
          rect.right > frame.right + 1 ||
          rect.top < frame.top - 1 ||
          rect.bottom > frame.bottom + 1;
        const over = names
          .slice(i + 1)
          .filter(
            ({ rect: b }) =>
              rect.left < b.right && b.left < rect.right && rect.top < b.bottom && b.top < rect.bottom,
          );
        return [
          ...(size < smallest ? [`${text}: ${size.toFixed(1)} px`] : []),
          ...(out ? [`${text} leaves its box`] : []),
          ...over.map((other) => `${text} covers ${other.text}`),
        ];
      });

      function textOf(element: HTMLElement): DOMRect {
        const range = document.createRange();
        range.selectNodeContents(element);
        return range.getBoundingClientRect();
      }
    }, SMALLEST - 0.01);

/** Pairs of boxes, open groups left out, that cover a part of each other. */
export const overlaps = (page: Page): Promise<string[]> =>
  panel(page, "Architecture")
    .locator(".graph-box, .graph-folded")
    .evaluateAll((all) => {
      const rects = all.map((one) => one.getBoundingClientRect());
      return rects.flatMap((a, i) =>
        rects
          .slice(i + 1)
          .filter((b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
          .map((b) => `${a.left},${a.top} and ${b.left},${b.top}`),
      );
    });

/** Wires that run behind a box. */
export const behind = (page: Page): Promise<string[]> =>
  panel(page, "Architecture").evaluate((around) => {
    const boxes = [...around.querySelectorAll(".graph-box, .graph-folded")].map((box) =>
      box.getBoundingClientRect(),
    );
    return [...around.querySelectorAll<SVGPathElement>(".graph-wire")].flatMap((path) => {
      const [length, matrix] = [path.getTotalLength(), path.getScreenCTM() as DOMMatrix];
      const hidden = Array.from({ length: 200 }, (_, i) => {
        const { x, y } = path.getPointAtLength((length * i) / 199).matrixTransform(matrix);
        return boxes.some(
          ({ left, right, top, bottom }) => x > left + 1 && x < right - 1 && y > top + 1 && y < bottom - 1,
        );
      });
      return hidden.includes(true) ? [path.parentElement?.getAttribute("aria-label") ?? path.id] : [];
    });
  });
