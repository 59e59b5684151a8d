// The one open question, and the promise of its answer. Dialogs.tsx draws it.

import { create } from "zustand";

type Conversations = {
  // Asks about unsaved edits before another document is opened.
  unsaved: { question: { title: string }; answer: "save" | "discard" | "cancel" };
  // A file is in the way; where it is the document's own, it was changed by something else.
  replace: { question: { path: string; own: boolean }; answer: "replace" | "elsewhere" | "cancel" };
  // A file below the root (its path), or one of the person's own: to open it, to show it to the sensors, or
  // for its values, or to compare it.
  choose: {
    question: { wants: "files" | "pictures" | "values" | "records" | "experiments" };
    answer: string | File | null;
  };
  save_as: { question: { path: string }; answer: string | null };
  // What became of the values of a file.
  taken: {
    question: { file: string; carried: number; unmatched: readonly string[] };
    answer: "keep" | "undo";
  };
  shortcuts: { question: null; answer: null };
  // The world that the sensors read, or one to use.
  world: { question: null; answer: null };
};

type Name = keyof Conversations;

export type Question<K extends Name> = Conversations[K]["question"];
export type AnswerTo<K extends Name> = Conversations[K]["answer"];

export type Asking<K extends Name> = {
  name: K;
  question: Question<K>;
  answer: (answer: AnswerTo<K>) => void;
};

export type Asked = { [K in Name]: Asking<K> }[Name];

type Dialogs = { asked: Asked | null; cancel: () => void };

const nothingAsked: Dialogs = { asked: null, cancel: () => {} };

export const useDialogs = create<Dialogs>(() => nothingAsked);

const CANCELLED: { [K in Name]: AnswerTo<K> } = {
  unsaved: "cancel",
  replace: "cancel",
  choose: null,
  save_as: null,
  taken: "keep",
  shortcuts: null,
  world: null,
};

// Asks the user. An open question is cancelled.
export function ask<K extends Name>(name: K, question: Question<K>): Promise<AnswerTo<K>> {
  useDialogs.getState().cancel();
  return new Promise((resolve) => {
    const answer = (given: AnswerTo<K>) => {
      useDialogs.setState(nothingAsked);
      resolve(given);
    };
    const asking: Asking<K> = { name, question, answer };
    useDialogs.setState({ asked: asking as unknown as Asked, cancel: () => answer(CANCELLED[name]) });
  });
}
