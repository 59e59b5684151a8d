/** What axe-core finds on a page: rules of accessible content, levels A and AA; and the size of targets. */
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import type { Result, RunOptions } from "axe-core";
import type { Page } from "playwright-core";

const SOURCE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"];

/** Wait until nothing fades or moves: half a transition has the contrast and the size of neither end. */
async function stillness(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const ends = ({ effect }: Animation) => effect?.getComputedTiming().endTime !== Number.POSITIVE_INFINITY;
    await Promise.allSettled(
      document
        .getAnimations()
        .filter(ends)
        .map(({ finished }) => finished),
    );
  });
}

/** One line for each finding: its rule and the element. `rules`: only these; none: all of levels A and AA. */
export async function findings(page: Page, rules?: string[]): Promise<string[]> {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(SOURCE);
  await stillness(page);
  const options: RunOptions = {
    runOnly: rules === undefined ? { type: "tag", values: TAGS } : { type: "rule", values: rules },
    rules: { "target-size": { enabled: false } }, // `smallTargets` measures them
    resultTypes: ["violations"],
  };
  const found = await page.evaluate(
    async (how) =>
      (
        await (
          window as unknown as { axe: { run: (how: object) => Promise<{ violations: Result[] }> } }
        ).axe.run(how)
      ).violations,
    options,
  );
  return found.flatMap(({ id, nodes }) =>
    nodes.map(
      (node) => `${id}: ${node.html.slice(0, 160)} (${node.any[0]?.message ?? node.all[0]?.message ?? ""})`,
    ),
  );
}

/**
 * The visible buttons, entries of menus and lists that are smaller than 24 by 24 pixels, with their size.
 * What lies on the canvas is left out: it has the size that its zoom gives it.
 */
export async function smallTargets(page: Page): Promise<string[]> {
  await stillness(page);
  return page.evaluate(() => {
    const targets = "button, [role=button], [role=menuitem], [role=option], select";
    return [...document.querySelectorAll<HTMLElement>(targets)].flatMap((target) => {
      const { width, height } = target.getBoundingClientRect();
      const shown = target.checkVisibility({ opacityProperty: true, visibilityProperty: true });
      const small = Math.min(width, height) < 23.9 && width * height > 0;
      const name = target.getAttribute("aria-label") ?? (target.innerText || target.className);
      const zoomed = target.closest(".react-flow__viewport") !== null;
      return shown && small && !zoomed ? [`${name}: ${width.toFixed(1)} x ${height.toFixed(1)}`] : [];
    });
  });
}

/** What axe-core finds, and targets that are too small. */
export const obstacles = async (page: Page): Promise<string[]> => [
  ...(await findings(page)),
  ...(await smallTargets(page)),
];
