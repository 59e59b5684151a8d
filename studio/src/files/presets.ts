// The values of another file, applied to the open document.

import type { Answer } from "../protocol";
import { request, socket } from "../server/socket";
import { useStudio } from "../server/store";
import { ask } from "../state/questions";
import { done, isTooLarge } from "./flows";
import { lastPart } from "../model/paths";

// Asks for a file, applies its values and shows those that did not match. True if values were applied and
// kept.
export async function takeValues(): Promise<boolean> {
  const chosen = await ask("choose", { wants: "values" });
  if (chosen === null || (chosen instanceof File && isTooLarge(chosen))) {
    return false;
  }
  return shown(await sent(chosen), typeof chosen === "string" ? lastPart(chosen) : chosen.name);
}

// Applies the values of a file below the root, and shows those that did not match.
export async function applyPreset(path: string): Promise<boolean> {
  return shown(await sent(path), lastPart(path));
}

// Applies a preset that the document keeps. The controls show what changed; only values that could not be
// applied are listed.
export async function applyKeptPreset(name: string): Promise<boolean> {
  const { answer } = await socket.ask({ type: "apply_kept_preset", name });
  return (answer.unmatched ?? []).length > 0 ? shown(answer, name) : done(answer);
}

async function shown(answer: Answer, file: string): Promise<boolean> {
  if (!done(answer)) {
    return false;
  }
  const { carried = 0, unmatched = [] } = answer;
  if (unmatched.length === 0) {
    useStudio.getState().notify({ what: takenText(carried, file) }, "info");
    return carried > 0;
  }
  if ((await ask("taken", { file, carried, unmatched })) === "undo") {
    await request({ type: "undo" });
    return false;
  }
  return carried > 0;
}

async function sent(chosen: string | File): Promise<Answer> {
  const message =
    typeof chosen === "string"
      ? ({ type: "apply_preset", path: chosen } as const)
      : ({ type: "apply_preset_text", name: chosen.name, text: await chosen.text() } as const);
  return (await socket.ask(message)).answer;
}

// How many values changed, in a sentence.
export function takenText(carried: number, file: string): string {
  return carried === 0
    ? `No value of ${file} differs from what is open.`
    : `${carried === 1 ? "1 value was" : `${carried} values were`} taken over from ${file}.`;
}
