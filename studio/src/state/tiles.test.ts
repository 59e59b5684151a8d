import { beforeEach, expect, test, vi } from "vitest";

import type { PlotParams } from "../model/settings";
import type { DocumentView } from "../protocol";
import { useStudio } from "../server/store";
import {
  addTile,
  beginTiles,
  changeTile,
  followTiles,
  moveTile,
  type PlotLists,
  removeTile,
  restoreTiles,
  settleTiles,
  tilesIn,
  useTiles,
} from "./tiles";
import { undo } from "./undo";

type Posted = {
  type: string;
  layout?: { tiles: { build?: PlotParams[] } };
  undoable?: boolean;
};

const sent: Posted[] = [];
let answer = (): void => {};
// The plots of the document; null: none of its own.
let own: PlotLists | null = null;

vi.mock("../server/socket", () => ({
  request: (message: Posted) => {
    sent.push(message);
    own = message.layout?.tiles ?? own;
    return new Promise((resolve) => {
      answer = () => resolve({});
    });
  },
}));

const plot = (element: string, kind = "curve"): PlotParams => ({
  element,
  kind,
  port: "activation",
  settings: {},
});
const open = (layout: object, record: object | null = null) =>
  useStudio.setState({ connection: "open", document: { layout, record } as unknown as DocumentView });
const shown = () => tilesIn(useTiles.getState(), "build").map(({ element, key }) => `${element}${key}`);
const follow = (lists: PlotLists | null) => {
  own = lists;
  followTiles();
};
const stored = () =>
  sent
    .at(-1)
    ?.layout?.tiles.build?.map(({ element }) => element)
    .join("");
const answered = async () => {
  answer();
  await Promise.resolve();
};

beforeEach(() => {
  vi.useFakeTimers();
  sent.length = 0;
  open({});
  own = null;
  beginTiles({ build: [plot("a"), plot("b"), plot("c")] }, () => own);
});

test("a plot that is opened or closed is one step of undo at once, and a movement is one in the end", () => {
  expect(shown()).toEqual(["a0", "b1", "c2"]);
  expect(addTile("build", plot("d"))).toBe(3);
  expect([stored(), sent.length, sent[0]?.undoable]).toEqual(["abcd", 1, true]);
  for (const to of [2, 1, 0, 4]) moveTile("build", 3, to);
  vi.advanceTimersByTime(700);
  expect([shown(), sent.length], "before the drag ends").toEqual([["d3", "a0", "b1", "c2"], 1]);
  settleTiles();
  expect([stored(), sent.length]).toEqual(["dabc", 2]);
  removeTile("build", 1);
  expect([stored(), sent.length]).toEqual(["dac", 3]);
});

test("a plot that is dragged there and back again is no step", async () => {
  moveTile("build", 0, 2);
  moveTile("build", 0, 0);
  settleTiles();
  expect(sent).toEqual([]);
});

test("plots of a record are no step of undo", () => {
  open({}, {});
  removeTile("build", 0);
  expect([stored(), sent[0]?.undoable]).toEqual(["bc", false]);
});

test("settings are stored after a pause as one step, or before the step that takes them back", () => {
  for (const down of [true, false]) changeTile("build", 0, { ...plot("a"), settings: { down } });
  expect(sent).toEqual([]);
  vi.advanceTimersByTime(700);
  expect(sent.map(({ type }) => type)).toEqual(["arrange"]);
  expect(sent[0]?.layout?.tiles.build?.[0]?.settings).toEqual({ down: false });
  changeTile("build", 0, plot("a"));
  void undo();
  vi.advanceTimersByTime(700);
  expect(sent.map(({ type }) => type)).toEqual(["arrange", "arrange", "undo"]);
});

test("plots that come back by undo are new tiles, and the others keep theirs", async () => {
  removeTile("build", 0);
  follow({ build: [plot("a"), plot("b"), plot("c")] });
  expect(shown(), "the answer is still to come").toEqual(["b1", "c2"]);
  await answered();
  expect(shown(), "it was undone meanwhile").toEqual(["a3", "b1", "c2"]);
  follow({ build: [plot("b"), plot("b")] });
  expect(shown()).toEqual(["b1", "b4"]);
  follow(null);
  expect(shown(), "as the document was opened").toEqual(["a5", "b1", "c6"]);
  expect(sent).toHaveLength(1);
});

test("the plots that the document was opened with are shown again", () => {
  restoreTiles();
  expect(sent).toEqual([]);
  removeTile("build", 2);
  addTile("run", plot("d"));
  restoreTiles();
  expect(shown()).toEqual(["a0", "b1", "c4"]);
  expect(useTiles.getState().views.run).toBeUndefined();
  expect(stored()).toBe("abc");
});

test("a session that begins forgets what was not stored", () => {
  changeTile("build", 0, { ...plot("a"), settings: { down: true } });
  beginTiles({ build: [plot("z")] }, () => null);
  vi.advanceTimersByTime(700);
  expect(sent).toEqual([]);
  expect(shown()).toEqual(["z0"]);
});
