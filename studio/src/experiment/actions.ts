// What the panel asks of the server.

import { ask } from "../state/questions";
import { done, leave, openExperiment, write, writeAs } from "../files/flows";
import { same } from "../model/part";
import type { Answer, ListedProblem } from "../protocol";
import { request, socket } from "../server/socket";
import { useStudio } from "../server/store";
import type { Data } from "./draft";
import { requestOf, useRunPlace } from "./runPlace";

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
    await before.then(() => leave({ type: "open_experiment", path }));
  }
}

export const create = () => before.then(() => leave({ type: "new_experiment" }));
export const close = () => before.then(() => leave({ type: "close_experiment" }));

// An edit that is under way is undone too.
export const undo = () => before.then(() => request({ type: "undo_experiment" }));
export const redo = () => before.then(() => request({ type: "redo_experiment" }));

// Whether keys are meant for the experiment.
export const hasFocus = (): boolean => document.activeElement?.closest(".experiment") != null;

// Run where the user chose; problems of the place are returned, for the panel.
export async function run(): Promise<ListedProblem[]> {
  const { answer } = await socket.ask({ type: "run_experiment", ...requestOf(useRunPlace.getState()) });
  return answer.problems ?? [];
}
export const stop = () => request({ type: "stop_experiment" });
export const repeat = (trial: number) => request({ type: "repeat_trial", trial });
export const backToModel = () => request({ type: "leave_trial" });

// A change that was made before is in the file.
export const save = (): Promise<boolean> => before.then(() => write(openExperiment()));
export const saveAs = (): Promise<boolean> => before.then(() => writeAs(openExperiment()));
