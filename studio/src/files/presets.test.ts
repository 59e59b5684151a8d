import { beforeEach, describe, expect, it } from "vitest";

import { fresh, notices, person, sent, server } from "./scripted";
import { applyKeptPreset, takeValues, takenText } from "./presets";

beforeEach(fresh);

describe("applying the values of a file", () => {
  it("shows the number of values if all matched", async () => {
    server({ carried: 3 });
    const questions = person("models/preset.json");
    expect(await takeValues()).toBe(true);
    expect(questions.map((q) => q.question)).toEqual([{ wants: "values" }]);
    expect(sent).toEqual([{ type: "apply_preset", path: "models/preset.json" }]);
    expect(notices()).toEqual(["info: 3 values were taken over from preset.json."]);
  });

  it("lists the values without a match", async () => {
    server({ carried: 1, unmatched: ["k: element Convolve: dropped"] });
    const questions = person("preset.json", "keep");
    expect(await takeValues()).toBe(true);
    expect(questions[1]?.question).toEqual({
      file: "preset.json",
      carried: 1,
      unmatched: ["k: element Convolve: dropped"],
    });
    expect(sent).toHaveLength(1);
    expect(notices()).toEqual([]);
  });

  it("is undone in one step from the list", async () => {
    server({ carried: 1, unmatched: ["k: element Convolve: dropped"] });
    person("preset.json", "undo");
    expect(await takeValues()).toBe(false);
    expect(sent.map((m) => m.type)).toEqual(["apply_preset", "undo"]);
  });

  it("sends a file of the user's own as text", async () => {
    server({});
    person(new File(["{}"], "preset.json"));
    expect(await takeValues()).toBe(false);
    expect(sent).toEqual([{ type: "apply_preset_text", name: "preset.json", text: "{}" }]);
    expect(notices()).toEqual(["info: No value of preset.json differs from what is open."]);
  });

  it("can be cancelled, and is refused if the file is too large or invalid", async () => {
    server({ problems: [{ what: "is no JSON" }] });
    const large = new File([], "preset.json");
    Object.defineProperty(large, "size", { value: 2 ** 30 });
    person(null, large, "broken.json");
    expect([await takeValues(), await takeValues()]).toEqual([false, false]);
    expect(notices()).toEqual([expect.stringContaining("preset.json is larger than")]);
    expect(await takeValues()).toBe(false);
    expect(sent).toHaveLength(1);
    expect(notices()).toEqual(["error: is no JSON"]);
  });

  it("states the number in words", () => {
    expect(takenText(0, "a.json")).toBe("No value of a.json differs from what is open.");
    expect(takenText(1, "a.json")).toBe("1 value was taken over from a.json.");
  });
});

describe("a preset of the document", () => {
  it("is applied without a word", async () => {
    server({ carried: 2 });
    person();
    expect(await applyKeptPreset("go: on")).toBe(true);
    expect(sent).toEqual([{ type: "apply_kept_preset", name: "go: on" }]);
    expect(notices()).toEqual([]);
  });

  it("lists the values that could not be applied", async () => {
    server({ carried: 1, unmatched: ["u: parameter tau: dropped"] });
    const questions = person("undo");
    expect(await applyKeptPreset("go: on")).toBe(false);
    expect(questions[0]?.question).toMatchObject({ file: "go: on", carried: 1 });
    expect(sent.map((m) => m.type)).toEqual(["apply_kept_preset", "undo"]);
  });

  it("that is unknown is a problem", async () => {
    server({ problems: [{ what: "the document has no preset 'x'" }] });
    person();
    expect(await applyKeptPreset("x")).toBe(false);
    expect(notices()).toEqual(["error: the document has no preset 'x'"]);
  });
});
