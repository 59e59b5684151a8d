// A server and a user with the answers of a test, and a record of the questions.

import { vi } from "vitest";
import type { Answer, Folder, ToServer } from "../protocol";
import { socket } from "../server/socket";
import { useStudio } from "../server/store";
import { type Asked, useDialogs } from "../state/questions";

// What was sent to the server since `fresh`.
export const sent: ToServer[] = [];
let leaves = () => {};

// A server that gives these answers in turn, and then reports success.
export function server(...answers: (Partial<Answer> & { folder?: Folder })[]): void {
  vi.spyOn(socket, "ask").mockImplementation(async (message) => {
    sent.push(message);
    const { folder = null, ...answer } = answers.shift() ?? {};
    return { answer: { type: "answer", request: 1, ...answer }, folder, fits: null };
  });
}

// A person who gives these answers in turn. Answers with the questions that stood there.
export function person(...answers: unknown[]): Asked[] {
  const questions: Asked[] = [];
  leaves = useDialogs.subscribe(({ asked }) => {
    if (asked !== null) {
      questions.push(asked);
      queueMicrotask(() => (asked.answer as (answer: unknown) => void)(answers.shift()));
    }
  });
  return questions;
}

// What the page says.
export function notices(): string[] {
  const { notice } = useStudio.getState();
  return notice?.problems.map(({ what }) => `${notice.level}: ${what}`) ?? [];
}

// Resets questions and answers, as before the first test.
export function fresh(): void {
  sent.length = 0;
  useStudio.setState(useStudio.getInitialState(), true);
  leaves();
  useDialogs.setState(useDialogs.getInitialState(), true);
  vi.restoreAllMocks();
}
