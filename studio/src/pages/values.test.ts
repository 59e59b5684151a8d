import { beforeEach, describe, expect, it, vi } from "vitest";

import type { Answer, ToServer } from "../protocol";
import { socket } from "../socket";
import { useStudio } from "../store";
import { type Asked, useDialogs } from "./dialogs";
import { takeValues, takenText } from "./values";

let sent: ToServer[];
let leaves = () => {};

// A server that gives these answers in turn, and then says that all is done.
function server(...answers: Partial<Answer>[]): void {
  vi.spyOn(socket, "ask").mockImplementation(async (message) => {
    sent.push(message);
    return { answer: { type: "answer", request: 1, ...answers.shift() }, folder: null };
  });
}

// A person who gives these answers in turn. Answers with the questions that stood there.
function person(...answers: unknown[]): Asked[] {
  const questions: Asked[] = [];
  leaves = useDialogs.subscribe(({ asked }) => {
    if (asked !== null) {
      questions.push(asked);
      queueMicrotask(() => (asked.answer as (answer: unknown) => void)(answers.shift()));
    }
  });
  return questions;
}

const notices = () => useStudio.getState().notices.map((n) => `${n.level}: ${n.problem.what}`);

beforeEach(() => {
  sent = [];
  useStudio.setState(useStudio.getInitialState(), true);
  leaves();
  useDialogs.setState(useDialogs.getInitialState(), true);
  vi.restoreAllMocks();
});

describe("taking over the values of a file", () => {
  it("says how many there were, where everything matched", async () => {
    server({ carried: 3 });
    const questions = person("models/preset.json");
    expect(await takeValues()).toBe(true);
    expect(questions.map((q) => q.question)).toEqual([{ wants: "values" }]);
    expect(sent).toEqual([{ type: "apply_preset", path: "models/preset.json" }]);
    expect(notices()).toEqual(["info: 3 values were taken over from preset.json."]);
  });

  it("shows what did not match", async () => {
    server({ carried: 1, unmatched: ["k: element Convolve: dropped"] });
    const questions = person("preset.json", "keep");
    expect(await takeValues()).toBe(true);
    expect(questions[1]?.question).toEqual({ file: "preset.json", carried: 1, unmatched: ["k: element Convolve: dropped"] });
    expect(sent).toHaveLength(1);
    expect(notices()).toEqual([]);
  });

  it("is one step back from there", async () => {
    server({ carried: 1, unmatched: ["k: element Convolve: dropped"] });
    person("preset.json", "undo");
    expect(await takeValues()).toBe(false);
    expect(sent.map((m) => m.type)).toEqual(["apply_preset", "undo"]);
  });

  it("takes a file of the person's own as text", async () => {
    server({});
    person(new File(["{}"], "preset.json"));
    expect(await takeValues()).toBe(false);
    expect(sent).toEqual([{ type: "apply_preset_text", name: "preset.json", text: "{}" }]);
    expect(notices()).toEqual(["info: No value of preset.json differs from what is open."]);
  });

  it("may be given up, and is refused where the file is too large or broken", async () => {
    server({ problems: [{ what: "is no JSON" }] });
    const large = new File([], "preset.json");
    Object.defineProperty(large, "size", { value: 2 ** 30 });
    person(null, large, "broken.json");
    expect([await takeValues(), await takeValues(), await takeValues()]).toEqual([false, false, false]);
    expect(sent).toHaveLength(1);
    expect(notices()).toEqual([expect.stringContaining("preset.json is larger than"), "error: is no JSON"]);
  });

  it("counts in words", () => {
    expect(takenText(0, "a.json")).toBe("No value of a.json differs from what is open.");
    expect(takenText(1, "a.json")).toBe("1 value was taken over from a.json.");
  });
});
