// The keys of the page and their actions, listed once; the help shows the same list.

import { useEffect } from "react";

import { copy, cut, duplicate, paste } from "../actions/clipboard";
import { openCommands } from "./commands";
import { addComment } from "../actions/commenting";
import { connectByKeys } from "../actions/connecting";
import { groupSelected, selectAll, ungroupSelected } from "../actions/grouping";
import { openPalette } from "../actions/palette";
import { disconnectByKeys, removeSelected } from "../actions/removing";
import { renameSelected } from "../actions/renaming";
import { getStage, isOnCanvas } from "../actions/stage";
import { ask, useDialogs } from "../state/questions";
import * as experiment from "../experiment/actions";
import { open, save, saveAs } from "../files/flows";
import { isPressed, isTyping, type Press, type Shortcut } from "../model/keys";
import { isPast, seekFirst, seekFrames, seekLast } from "../actions/replay";
import { request } from "../server/socket";
import { usePage } from "../state/page";
import { undo } from "../state/undo";
import { useStudio } from "../server/store";
import { play, reset, step } from "../actions/run";
import { stopRobot } from "../world/LinkState";

export const SHORTCUTS: readonly Shortcut[] = [
  { keys: ["Space"], does: "Play or pause", run: play },
  { keys: ["."], does: "Step", run: step, repeats: true },
  { keys: ["Shift+R"], does: "Reset", run: reset },
  { keys: ["Escape"], does: "Stop a robot in another process", run: stopRobot, event: true },
  {
    keys: ["ArrowLeft"],
    does: "Previous frame, of the past or of a record",
    run: () => seekFrames(-1),
    repeats: true,
    past: true,
  },
  { keys: ["ArrowRight"], does: "Next frame", run: () => seekFrames(1), repeats: true, past: true },
  { keys: ["Home"], does: "First frame", run: seekFirst, past: true },
  { keys: ["End"], does: "Last frame", run: seekLast, past: true },
  {
    keys: ["Ctrl+Z"],
    does: "Undo, in the experiment if its panel has the focus",
    run: () => (experiment.hasFocus() ? experiment.undo() : undo()),
    repeats: true,
  },
  {
    keys: ["Ctrl+Shift+Z", "Ctrl+Y"],
    does: "Redo",
    run: () => (experiment.hasFocus() ? experiment.redo() : request({ type: "redo" })),
    repeats: true,
  },
  {
    keys: ["/"],
    does: "Add an element (also Tab, with the pointer on the canvas)",
    run: () => openPalette(),
  },
  { keys: ["Ctrl+K"], does: "Find a command or an element", run: () => openCommands(SHORTCUTS) },
  { keys: ["F"], does: "Show the whole architecture", run: () => getStage()?.showAll(), canvas: true },
  { keys: ["C"], does: "Connect the selected element", run: () => connectByKeys(), canvas: true },
  { keys: ["X"], does: "Remove a connection of the selected element", run: disconnectByKeys, canvas: true },
  { keys: ["Delete", "Backspace"], does: "Remove what is selected", run: removeSelected, canvas: true },
  { keys: ["F2"], does: "Rename", run: renameSelected, canvas: true },
  { keys: ["Ctrl+C"], does: "Copy", run: copy, canvas: true, event: true },
  { keys: ["Ctrl+X"], does: "Cut", run: cut, canvas: true, event: true },
  { keys: ["Ctrl+V"], does: "Paste", run: () => paste(), canvas: true, event: true },
  { keys: ["Ctrl+D"], does: "Duplicate", run: duplicate, canvas: true },
  { keys: ["Ctrl+A"], does: "Select everything", run: selectAll, canvas: true },
  { keys: ["Ctrl+G", "G"], does: "Group", run: groupSelected, canvas: true },
  { keys: ["Shift+C"], does: "Add a comment", run: () => addComment(), canvas: true },
  { keys: ["Shift+G"], does: "Ungroup", run: ungroupSelected, canvas: true },
  { keys: ["Ctrl+O"], does: "Open a file", run: open, always: true, typing: true },
  { keys: ["Ctrl+S"], does: "Save", run: () => save(), typing: true },
  { keys: ["Ctrl+Shift+S"], does: "Save as", run: saveAs, typing: true },
  { keys: ["?"], does: "Show this list", run: () => ask("shortcuts", null), always: true },
];

// Whether the text field uses keys with Ctrl too: a choice from a list does not.
function isWriting(target: Element | null, press: Press): boolean {
  return (
    isTyping(target) && !((press.ctrlKey || press.metaKey) && target?.closest("input:read-only") != null)
  );
}

// What Space presses where it has the focus.
const PRESSED =
  "button, a, summary, input:not([type=range]), [role=menuitem], [role=option], [role=switch], " +
  "[role=checkbox], [role=tab]";

// What the arrow keys, Home and End move where it has the focus.
const MOVED =
  "input, select, [role=slider], [role=menu], [role=listbox], [role=tab], [role=radio], .react-flow__node, " +
  ".world";

export function useShortcuts(): void {
  useEffect(() => {
    // A clicked button keeps the focus, but shows no focus ring: then Space plays. Read on focus, because the
    // first key makes the ring visible.
    let focusSeen = false;
    const onFocus = (event: FocusEvent) => {
      focusSeen = event.target instanceof Element && event.target.matches(":focus-visible");
    };
    const listening = new AbortController();
    addEventListener("focusin", onFocus, listening);
    addEventListener("keydown", (event) => onKey(event, focusSeen), listening);
    return () => listening.abort();
  }, []);
}

function onKey(event: KeyboardEvent, focusSeen: boolean): void {
  const shortcut = SHORTCUTS.find(({ keys }) => keys.some((k) => isPressed(k, event)));
  if (shortcut === undefined || shortcut.event === true || event.defaultPrevented) {
    return;
  }
  const target = event.target instanceof Element ? event.target : null;
  const typing = isWriting(target, event);
  if (
    (typing && shortcut.typing !== true) ||
    (event.key === " " && focusSeen && target?.closest(PRESSED) != null) ||
    (shortcut.canvas === true && !isOnCanvas(target)) ||
    (shortcut.past === true && (!isPast() || target?.closest(MOVED) != null))
  ) {
    return;
  }
  event.preventDefault();
  const { document, fileProblems } = useStudio.getState();
  const shown = document !== null && fileProblems === null && !usePage.getState().gallery;
  const ready = shown || shortcut.always === true;
  if (!ready || useDialogs.getState().asked !== null || (event.repeat && shortcut.repeats !== true)) {
    return;
  }
  if (typing && target instanceof HTMLElement) {
    target.blur();
  }
  shortcut.run();
}
