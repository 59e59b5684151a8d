import { readdirSync } from "node:fs";
import { join } from "node:path";

import { expect, test } from "vitest";

import { fakeCosivina, fakeExample, fakeKind, kindsOf } from "../../architecture/fakes";
import { PANEL } from "../../architecture/layout";
import { meet, type Rect } from "../../model/rects";
import { rectsOf } from "../../architecture/nodes";
import { scene } from "../../architecture/scene";
import { roomOf, withCourses } from "../../architecture/courses";
import type { DocumentView } from "../../protocol";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("GaussianStimulus", "elements"),
  fakeKind("Noise", "elements", { equation: ["\\xi"] }),
  fakeKind("Gain", "couplings"),
);
const COSIVINA = join(import.meta.dirname, "../../../../tests/deodar_interop/importers/cosivina");
const EXAMPLES = join(import.meta.dirname, "../../../../examples");
const HEIGHT = 22;

const filesIn = (folder: string) => readdirSync(folder).filter((name) => name.endsWith(".json"));

/** The chips of a document that cover a part of each other or of a box. */
function covered(document: DocumentView, panel = PANEL): string[] {
  const now = scene(document, KINDS, panel);
  const rects = rectsOf(now.nodes);
  const boxes = now.nodes.flatMap(({ id, type }): [string, Rect][] =>
    type === "frame" ? [] : [[id, rects.get(id) as Rect]],
  );
  const chips = withCourses(now).flatMap(({ id, data }): [string, Rect][] => {
    const width = roomOf(data);
    const { x, y } = data?.course?.middle ?? { x: NaN, y: NaN };
    return width === 0 ? [] : [[id, { x: x - width / 2, y: y - HEIGHT / 2, width, height: HEIGHT }]];
  });
  return chips.flatMap(([id, chip], i) =>
    [...chips.slice(i + 1), ...boxes].flatMap(([other, rect]) =>
      meet(chip, rect) ? [`${id} | ${other}`] : [],
    ),
  );
}

test.each(filesIn(COSIVINA))(
  "chips of %s cover nothing",
  (file) => {
    expect(covered(fakeCosivina(file))).toEqual([]);
    expect(covered(fakeCosivina(file), { width: 676, height: 540 })).toEqual([]);
  },
  60_000,
);

test.each(filesIn(EXAMPLES))(
  "chips of the example %s cover nothing",
  (file) => {
    expect(covered(fakeExample(file.replace(".json", "")))).toEqual([]);
  },
  60_000,
);
