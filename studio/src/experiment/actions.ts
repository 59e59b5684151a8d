// What the panel asks of the server.

import { ask } from "../pages/dialogs";
import { done, leave } from "../pages/flows";
import { same } from "../inspector/part";
import type { Answer } from "../protocol";
import { request, socket } from "../socket";
import { useStudio } from "../store";
import type { Data } from "./draft";

// The last change that was sent: the next one is made of the data after it.
let before: Promise<unknown> = Promise.resolve();

// Change the plain data; a change of another page in between is an error.
export function edit(change: (data: Data) => Data): Promise<Answer> {
  const sent = before.then(async () => {
    const experiment = useStudio.getState().experiment;
    const old = (experiment?.data ?? {}) as Data;
    const data = change(old);
    if (same(data, old)) {
      return NOTHING;
    }
    const { answer } = await socket.ask({ type: "edit_experiment", data, version: experiment?.version ?? 0 });
    done(answer);
    return answer;
  });
  before = sent.catch(() => undefined);
  return sent;
}

const NOTHING: Answer = { type: "answer", request: 0 };

export async function open(): Promise<void> {
  const path = await ask("choose", { wants: "experiments" });
  if (typeof path === "string") {
    await leave({ type: "open_experiment", path });
  }
}

export const create = () => request({ type: "new_experiment" });
export const close = () => request({ type: "close_experiment" });
export const run = () => request({ type: "run_experiment" });
export const stop = () => request({ type: "stop_experiment" });
export const repeat = (trial: number) => leave({ type: "repeat_trial", trial });
export const backToModel = () => request({ type: "leave_trial" });

// Write the experiment, to its own file where the path is empty. True where it was written.
export async function save(path = "", replace = false): Promise<boolean> {
  const own = useStudio.getState().experiment?.file ?? "";
  if (path === "" && own === "") {
    return saveAs();
  }
  const { answer } = await socket.ask({ type: "save_experiment", path, replace });
  if (answer.ask !== "replace") {
    if (done(answer)) {
      useStudio.getState().notify({ what: `Saved as ${answer.file || path || own}` }, "info");
      return true;
    }
    return false;
  }
  switch (await ask("replace", { path: path || own, own: false })) {
    case "replace":
      return save(path, true);
    case "elsewhere":
      return saveAs();
    case "cancel":
      return false;
  }
}

export async function saveAs(): Promise<boolean> {
  const { experiment } = useStudio.getState();
  const path = await ask("save_as", { path: experiment?.file || String(experiment?.data?.["name"] ?? "") });
  return path === null ? false : save(path);
}
