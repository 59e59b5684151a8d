// The rows of the table of costs: measured times with the present names of elements.

import type { CostView, Costs, ElementView } from "../protocol";

export type CostRow = {
  key: string;
  // the element to select; null where a row is no element of the document
  element: string | null;
  path: string;
  kind: string;
  us: number;
  // share of the most expensive row, 0 to 1: the length of its bar
  bar: number;
  share: string;
  time: string;
  about: string;
};

export function costRows(costs: Costs, elements: Map<string, ElementView>): CostRow[] {
  const sum = sumOf(costs);
  const most = Math.max(...costs.elements.map(({ us }) => us), 0);
  return costs.elements.map((cost, i) => {
    const element = elements.get(cost.element);
    return {
      key: `${i} ${cost.element}`,
      element: element === undefined ? null : element.id,
      path: element?.path ?? cost.path,
      kind: cost.kind,
      us: cost.us,
      bar: most > 0 ? cost.us / most : 0,
      share: cost.once || sum === 0 ? "" : `${((100 * cost.us) / sum).toFixed(1)} %`,
      time: cost.once ? "once" : microsecondsText(cost.us),
      about: aboutOf(cost),
    };
  });
}

export function sumOf({ elements }: Costs): number {
  return elements.reduce((sum, { us }) => sum + us, 0);
}

// Three digits that matter: 0.03, 1.23, 45.6, 1230.
export function microsecondsText(us: number): string {
  return us.toFixed(us < 9.995 ? 2 : us < 99.95 ? 1 : 0);
}

function aboutOf({ once, alike }: CostView): string {
  if (once) {
    return "Constant: computed after a change and a few times a second, not in every step";
  }
  return alike > 1
    ? `Computed together with ${alike - 1} of the same structure; they share the time equally`
    : "Computed alone";
}
