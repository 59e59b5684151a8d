// Conversations with the person and the server that take several steps: opening, saving, reading a file of
// the person's own.

import { ask } from "../state/questions";
import { openTool } from "../state/tool";
import { saveFile } from "../server/save";
import type { Answer, ListedProblem, Save, SaveExperiment, ToServer } from "../protocol";
import { request, socket } from "../server/socket";
import { settleTiles } from "../state/tiles";
import { useStudio } from "../server/store";
import { opening, sortOf } from "../model/paths";

// The largest message that the server accepts, base64 included.
const MOST_BYTES = 40 * 2 ** 20;

// Messages that lead to another document, or to none.
type Leaving = Extract<ToServer, { discard?: boolean } | { discard_experiment?: boolean }>;

// Unsaved edits are asked about. True where it was done.
export async function leave(message: Leaving): Promise<boolean> {
  settleTiles();
  const { answer } = await socket.ask(message);
  const { experiment, document } = useStudio.getState();
  const ofExperiment = answer.ask === "unsaved_experiment";
  if (!ofExperiment && answer.ask !== "unsaved") {
    return done(answer) && arrived(answer);
  }
  const name = `The experiment ${String(experiment?.data?.["name"] ?? "")}`;
  switch (await ask("unsaved", { title: ofExperiment ? name : (document?.title ?? "") })) {
    case "save":
      return (
        (ofExperiment ? await write(openExperiment()) : (await toModel()) && (await save())) && leave(message)
      );
    case "discard":
      return leave({ ...message, [ofExperiment ? "discard_experiment" : "discard"]: true } as Leaving);
    case "cancel":
      return false;
  }
}

// The document that was set aside for the record of a trial is open again before it is saved.
async function toModel(): Promise<boolean> {
  const repeated = useStudio.getState().experiment?.repeated ?? null;
  return repeated === null || done((await socket.ask({ type: "leave_trial" })).answer);
}

export async function open(): Promise<boolean> {
  const chosen = await ask("choose", { wants: "files" });
  return typeof chosen === "string"
    ? leave({ type: "open_file", path: chosen })
    : chosen !== null && takeFile(chosen);
}

// Open a document without elements and without a file.
export function openEmpty(): Promise<boolean> {
  return leave({ type: "new" });
}

// Compare the open record with another one.
export async function compare(): Promise<boolean> {
  const path = await ask("choose", { wants: "records" });
  return typeof path === "string" && succeeded(await request({ type: "compare_record", path }));
}

// Something that the server writes below the root.
export type Saved = {
  // Its own file; empty: none yet.
  file: string;
  // Its name where it has no file.
  name: string;
  message: (path: string, replace: boolean) => Save | SaveExperiment;
};

// Write it, to its own file where the path is empty. True where it was written.
export async function write(saved: Saved, path = "", replace = false): Promise<boolean> {
  const { file, message } = saved;
  if (path === "" && file === "") {
    return writeAs(saved);
  }
  settleTiles();
  const { answer } = await socket.ask(message(path, replace));
  if (answer.ask !== "replace") {
    return done(answer) && told(`Saved as ${answer.file || path || file}`);
  }
  const inTheWay = answer.file || path || file;
  switch (await ask("replace", { path: inTheWay, own: inTheWay === file })) {
    case "replace":
      return write(saved, path, true);
    case "elsewhere":
      return writeAs(saved);
    case "cancel":
      return false;
  }
}

// Ask for a path, and write it there.
export async function writeAs(saved: Saved): Promise<boolean> {
  const path = await ask("save_as", { path: saved.file || saved.name });
  return path === null ? false : write(saved, path);
}

function openDocument(): Saved {
  const { file = "", title: name = "" } = useStudio.getState().document ?? {};
  return { file, name, message: (path, replace) => ({ type: "save", path, replace }) };
}

export function openExperiment(): Saved {
  const { experiment } = useStudio.getState();
  return {
    file: experiment?.file ?? "",
    name: String(experiment?.data?.["name"] ?? ""),
    message: (path, replace) => ({ type: "save_experiment", path, replace }),
  };
}

export const save = (path = ""): Promise<boolean> => write(openDocument(), path);
export const saveAs = (): Promise<boolean> => writeAs(openDocument());

// The document as a Python script that makes the same document, written to the folder of downloads.
export async function exportScript(): Promise<void> {
  const { text = "" } = await request({ type: "export_script" });
  if (text !== "") {
    saveFile(new Blob([text], { type: "text/x-python" }), openDocument().name, "py");
  }
}

// Opens a dropped or chosen file: a document, or a file for the sensors, such as a picture.
export async function takeFile(file: File): Promise<boolean> {
  if (isTooLarge(file)) {
    return false;
  }
  switch (sortOf(file)) {
    case "document":
      return leave({ type: "open_text", name: file.name, text: await file.text() });
    case "package":
      return leave({ type: "open_package", name: file.name, content: await base64(file) });
    case "other":
      return showToSensors(file, file.name);
  }
}

// Opens what was dropped: a record where it lies, since a page cannot read a folder as one file.
export function takeDropped(dropped: { file: File; folder: boolean }): Promise<boolean> {
  const { file, folder } = dropped;
  const sensed = useStudio.getState().clock?.senses === true; // then the world shows a recording
  const record = folder || /\.zip$/i.test(file.name) || (/\.nc$/i.test(file.name) && !sensed);
  return record ? openRecord(file) : takeFile(file);
}

async function openRecord({ name }: File): Promise<boolean> {
  if (/\.zip$/i.test(name)) {
    return refuse({
      what: `${name} is a zip file, which the studio does not open.`,
      fix: "Unpack it below the studio's folder, and open it with Ctrl+O.",
    });
  }
  const { folder } = await socket.ask({ type: "list_folder", path: "" });
  if (folder?.records.includes(name)) {
    return leave({ type: "open_file", path: name });
  }
  const root = useStudio.getState().welcome?.root ?? "";
  return refuse({
    what: `The folder of the studio, ${root}, contains no record ${name}.`,
    fix: `If it lies in a folder below, open it with Ctrl+O, otherwise type: deodar studio PATH/${name}`,
  });
}

// Whether a file is too large for one message; then a notice states it.
export function isTooLarge(file: Pick<File, "name" | "size">): boolean {
  if (file.size > MOST_BYTES) {
    refuse({
      what: `${file.name} is larger than ${MOST_BYTES / 2 ** 20} MB.`,
      fix: "Put it below the studio's folder and open it there.",
    });
  }
  return file.size > MOST_BYTES;
}

// Let the sensors read a file by the kind of world that opens it: below the root by its path, otherwise its
// content.
async function showToSensors(file: string | File, name: string): Promise<boolean> {
  const { kinds, clock } = useStudio.getState();
  const world = opening(kinds.values(), name);
  if (world === undefined) {
    return refuse({ what: `${name} is neither a document (.json, .deodar) nor a file that a world opens.` });
  }
  if (clock?.senses !== true) {
    return refuse({
      what: `This document has no sensor for ${name}.`,
      fix: "Open a document with a sensor first, for example one from the gallery.",
    });
  }
  const answer =
    typeof file === "string"
      ? await request({ type: "use_world", kind: world.name, path: file })
      : await request({ type: "use_world_content", kind: world.name, name, content: await base64(file) });
  return succeeded(answer);
}

// Shows the report of a file of another tool, and says what a package was.
function arrived({ imported = "", text = "" }: Answer): boolean {
  if (text !== "") {
    told(text);
  }
  if (imported !== "") {
    useStudio
      .getState()
      .notify({ what: imported }, "info", { label: "Show the report", run: () => openTool("report") });
  }
  return true;
}

export const succeeded = ({ problems = [] }: Answer): boolean => problems.length === 0;

// Problems become a notice.
export function done(answer: Answer): boolean {
  return succeeded(answer) || refuse(answer.problems ?? []);
}

function told(what: string): true {
  useStudio.getState().notify({ what }, "info");
  return true;
}

function refuse(problem: ListedProblem | readonly ListedProblem[]): false {
  useStudio.getState().notify(problem);
  return false;
}

export async function base64(file: File): Promise<string> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const parts: string[] = [];
  for (let i = 0; i < bytes.length; i += 0x8000) {
    parts.push(String.fromCharCode(...bytes.subarray(i, i + 0x8000)));
  }
  return btoa(parts.join(""));
}
