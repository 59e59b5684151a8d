// Copy, cut and paste of what is selected, as a document in JSON: between pages, windows and files. The
// events of the browser carry the text; where a page may not write to the clipboard by itself, the old
// command does.

import { isTooLarge } from "../files/flows";
import { boundsOf, type Point } from "../model/rects";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { showMade } from "./made";
import { isEditable } from "../state/editable";
import { extentOf } from "./extent";
import { afterAll, free, groupAt, pathOf } from "./placing";
import { removeSelected } from "./removing";
import { chosen } from "./selection";
import { getPointer, getStage, isOnCanvas, middleOf } from "./stage";

const APART = 32;

// The text that was copied last, where the clipboard cannot be read.
let last = "";
// The copy that still waits for the server: a paste right after it waits too, and pastes its text.
let copying: Promise<boolean> | null = null;
// Whether this module writes to the clipboard by the old command, which is an event too.
let writing = false;

// What is selected as text; empty where nothing is.
async function selectedText(): Promise<string> {
  const { elements, groups } = chosen();
  if (elements.length + groups.length === 0) {
    return "";
  }
  return (await request({ type: "copy", elements, groups })).text ?? "";
}

export function copy(): Promise<boolean> {
  const mine = copySelected().finally(() => {
    if (copying === mine) {
      copying = null;
    }
  });
  copying = mine;
  return mine;
}

async function copySelected(): Promise<boolean> {
  const text = await selectedText();
  if (text !== "") {
    last = text;
    await write(text);
  }
  return text !== "";
}

export async function cut(): Promise<void> {
  if (isEditable() && (await copy())) {
    await removeSelected();
  }
}

export async function paste(text?: string): Promise<void> {
  const stage = getStage();
  if (!isEditable() || stage === null) {
    return;
  }
  const copied = (await copying?.catch(() => false)) ?? false;
  const content = copied ? last : (text ?? (await read()));
  if (content.trim() === "") {
    useStudio.getState().notify({ what: "The clipboard holds no elements." }, "info");
    return;
  }
  if (isTooLarge({ name: "The text in the clipboard", size: content.length })) {
    return;
  }
  const pointer = getPointer();
  await insertFree(content, pointer === null ? middleOf(stage) : stage.toFlow(pointer));
}

// The selection once more, a little aside.
export async function duplicate(): Promise<void> {
  const corner = cornerOf(allChosen());
  if (isEditable() && corner !== null) {
    const text = await selectedText();
    await insertFree(text, { x: corner.x + APART, y: corner.y + APART });
  }
}

// The selection once more, with its upper left corner at a point of the canvas.
export async function copyTo(at: Point): Promise<void> {
  const text = await selectedText();
  if (text !== "") {
    await insert(text, at);
  }
}

// Insert where nothing lies, as near to a point as the size of the whole lets it.
async function insertFree(text: string, at: Point): Promise<void> {
  const scene = getStage()?.scene();
  if (scene === undefined || text === "") {
    return;
  }
  const whole = extentOf(text, useStudio.getState().kinds);
  if (whole === null) {
    await insert(text, (afterAll(scene) ?? { at }).at);
    return;
  }
  const { pad, size } = whole;
  const { at: place, group } = free({ x: at.x - pad.x, y: at.y - pad.y }, size, groupAt(at, scene), scene);
  await insert(text, { x: place.x + pad.x, y: place.y + pad.y }, group);
}

async function insert(text: string, at: Point, group?: string): Promise<void> {
  const { document } = useStudio.getState();
  const scene = getStage()?.scene();
  const key = group ?? (scene === undefined ? "" : groupAt(at, scene));
  const answer = await request({
    type: "paste",
    text,
    group: document === null ? [] : pathOf(key, document),
    at: [Math.round(at.x), Math.round(at.y)],
  });
  showMade(answer.made ?? []);
}

// All selected elements, also those of selected groups.
const allChosen = (): string[] => useStudio.getState().selected;

export function cornerOf(elements: string[]): Point | null {
  const places = getStage()?.scene().places.elements;
  const found = elements.flatMap((id) => places?.get(id) ?? []);
  return found.length === 0 ? null : boundsOf(found);
}

async function write(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    writing = true;
    document.execCommand("copy");
    writing = false;
    field.remove();
  }
}

async function read(): Promise<string> {
  try {
    return await navigator.clipboard.readText();
  } catch {
    return last;
  }
}

// Whether an event of the clipboard is meant for the canvas: no text is selected or typed.
function isMeant(): boolean {
  const focus = document.activeElement;
  return !writing && isOnCanvas(focus) && focus?.matches("input, textarea") !== true && selectsNoText();
}

const selectsNoText = (): boolean => getSelection()?.isCollapsed !== false;

// Listen to the clipboard's events; gives what ends it.
export function listen(): () => void {
  const take = (act: (event: ClipboardEvent) => unknown) => (event: ClipboardEvent) => {
    if (isMeant()) {
      event.preventDefault();
      void act(event);
    }
  };
  const taken = {
    copy: take(copy),
    cut: take(cut),
    paste: take((event) => paste(event.clipboardData?.getData("text/plain") || last)),
  };
  const listening = new AbortController();
  for (const [name, act] of Object.entries(taken)) {
    document.addEventListener(name, act as EventListener, listening);
  }
  return () => listening.abort();
}
