import { beforeEach, describe, expect, it, vi } from "vitest";

import { fakeKind, fakeLayout } from "../architecture/fakes";
import { openTool } from "../state/tool";
import type { DocumentView, ExperimentView, Folder, Kind, Welcome } from "../protocol";
import { useStudio } from "../server/store";
import { leave, open, save, saveAs, takeDropped, takeFile } from "./flows";
import { fresh, notices, person, sent, server } from "./scripted";

vi.mock("../state/tool", () => ({ openTool: vi.fn() }));

const document: DocumentView = {
  file: "",
  title: "selection",
  time_unit: "ms",
  dt: null,
  notes: "",
  axes: [],
  elements: [],
  connections: [],
  groups: [],
  parameters: [],
  layout: fakeLayout(),
  problems: [],
  unsaved: true,
  undo: 1,
  redo: 0,
};
const picture = fakeKind("Picture", "worlds", { opens: [".png"] });
const arena: Kind = { ...picture, name: "Arena", title: "Arena", opens: [".json"] };
const worlds = new Map([arena, picture].map((kind) => [kind.name, kind]));

function given(state: Partial<DocumentView>): void {
  useStudio.setState({ document: { ...document, ...state } });
}

beforeEach(fresh);

describe("leaving a document", () => {
  it("asks nothing if all edits are saved", async () => {
    server({});
    const questions = person();
    expect(await leave({ type: "open_example", name: "selection" })).toBe(true);
    expect(questions).toEqual([]);
    expect(sent).toEqual([{ type: "open_example", name: "selection" }]);
  });

  it("discards unsaved edits if the user chooses so", async () => {
    given({});
    server({ ask: "unsaved" }, {});
    const questions = person("discard");
    expect(await leave({ type: "close" })).toBe(true);
    expect(questions[0]?.question).toEqual({ title: "selection" });
    expect(sent).toEqual([{ type: "close" }, { type: "close", discard: true }]);
  });

  it("is cancelled by the user", async () => {
    given({});
    server({ ask: "unsaved" });
    person("cancel");
    expect(await leave({ type: "close" })).toBe(false);
    expect(sent).toHaveLength(1);
  });

  it("saves first, and asks for a name if there is none", async () => {
    given({});
    server({ ask: "unsaved" }, {}, {});
    const questions = person("save", "models/mine.json");
    expect(await leave({ type: "close" })).toBe(true);
    expect(questions.map((q) => q.name)).toEqual(["unsaved", "save_as"]);
    expect(sent.map((m) => m.type)).toEqual(["close", "save", "close"]);
  });

  it("returns from the record of a trial before it saves", async () => {
    useStudio.setState({ experiment: { repeated: 5 } as ExperimentView });
    given({ file: "a.json" });
    server({ ask: "unsaved" }, {}, {}, {});
    person("save");
    expect(await leave({ type: "open_file", path: "b.json" })).toBe(true);
    expect(sent.map((m) => m.type)).toEqual(["open_file", "leave_trial", "save", "open_file"]);
  });

  it("asks about the experiment, saves it, and then asks about the document", async () => {
    const experiment = { data: { name: "trials" }, file: "exp.json" } as unknown as ExperimentView;
    useStudio.setState({ experiment });
    given({});
    server({ ask: "unsaved_experiment" }, {}, { ask: "unsaved" }, {});
    const questions = person("save", "discard");
    expect(await leave({ type: "open_experiment", path: "b.json" })).toBe(true);
    expect(questions.map((q) => q.question)).toEqual([
      { title: "The experiment trials" },
      { title: "selection" },
    ]);
    expect(sent.map((m) => m.type)).toEqual([
      "open_experiment",
      "save_experiment",
      "open_experiment",
      "open_experiment",
    ]);
    expect(sent[3]).toEqual({ type: "open_experiment", path: "b.json", discard: true });
  });

  it("discards the edits of the experiment alone", async () => {
    server({ ask: "unsaved_experiment" }, {});
    person("discard");
    expect(await leave({ type: "close_experiment" })).toBe(true);
    expect(sent[1]).toEqual({ type: "close_experiment", discard_experiment: true });
  });

  it("is cancelled if the user cancels saving", async () => {
    given({});
    server({ ask: "unsaved" });
    person("save", null);
    expect(await leave({ type: "close" })).toBe(false);
    expect(sent).toHaveLength(1);
  });

  it("shows the reason if the server refuses", async () => {
    server({ problems: [{ what: "lies outside" }] });
    expect(await leave({ type: "open_file", path: "../a.json" })).toBe(false);
    expect(notices()).toEqual(["error: lies outside"]);
  });
});

describe("opening", () => {
  it("sends the path of a file below the root", async () => {
    server({});
    person("models/a.json");
    expect(await open()).toBe(true);
    expect(sent).toEqual([{ type: "open_file", path: "models/a.json" }]);
  });

  it("sends a file of the user's own as text", async () => {
    server({});
    person(new File(['{"deodar": 1}'], "a.json"));
    expect(await open()).toBe(true);
    expect(sent).toEqual([{ type: "open_text", name: "a.json", text: '{"deodar": 1}' }]);
  });

  it("sends a package as its bytes", async () => {
    server({});
    person(new File(["PK\u0003\u0004"], "a.deodar"));
    expect(await open()).toBe(true);
    expect(sent).toEqual([{ type: "open_package", name: "a.deodar", content: "UEsDBA==" }]);
  });

  it("shows the summary of an imported file, and offers the report", async () => {
    server({ imported: "Imported from a.json (another tool): 1 element." });
    expect(await takeFile(new File(["{}"], "a.json"))).toBe(true);
    expect(notices()).toEqual(["info: Imported from a.json (another tool): 1 element."]);
    useStudio.getState().notice?.offers[0]?.run();
    expect(openTool).toHaveBeenCalledWith("report");
  });

  it("says what a package was", async () => {
    server({ text: "a.deodar is unpacked in a: a record" });
    person("a.deodar");
    expect(await open()).toBe(true);
    expect(notices()).toEqual(["info: a.deodar is unpacked in a: a record"]);
  });

  it("can be cancelled", async () => {
    server();
    person(null);
    expect(await open()).toBe(false);
    expect(sent).toEqual([]);
  });
});

describe("saving", () => {
  it("writes to the file of the document and shows a notice", async () => {
    given({ file: "a.json" });
    server({});
    expect(await save()).toBe(true);
    expect(sent).toEqual([{ type: "save", path: "", replace: false }]);
    expect(notices()).toEqual(["info: Saved as a.json"]);
  });

  it("asks before it overwrites another file", async () => {
    given({ file: "a.json" });
    server({ ask: "replace" }, {}, { ask: "replace" }, { file: "models/b.json" });
    const questions = person("replace", "replace");
    expect(await save()).toBe(true);
    expect(await save("models/b.json")).toBe(true);
    expect(questions.map((q) => q.question)).toEqual([
      { path: "a.json", own: true },
      { path: "models/b.json", own: false },
    ]);
    expect(sent[1]).toEqual({ type: "save", path: "", replace: true });
    expect(sent[3]).toEqual({ type: "save", path: "models/b.json", replace: true });
    expect(notices()).toEqual(["info: Saved as models/b.json"]);
  });

  it("writes to another file if the user chooses so", async () => {
    given({ file: "a.json" });
    server({ ask: "replace" }, {});
    const questions = person("elsewhere", "b.json");
    expect(await save()).toBe(true);
    expect(questions[1]?.question).toEqual({ path: "a.json" });
    expect(sent[1]).toEqual({ type: "save", path: "b.json", replace: false });
  });

  it("proposes the title if the document has no file", async () => {
    given({});
    server({});
    const questions = person("selection.json");
    expect(await saveAs()).toBe(true);
    expect(questions[0]?.question).toEqual({ path: "selection" });
  });

  it("shows a notice if it fails", async () => {
    given({ file: "a.json" });
    server({ problems: [{ what: "The disk is full" }] });
    expect(await save()).toBe(false);
    expect(notices()).toEqual(["error: The disk is full"]);
  });
});

describe("a dropped record", () => {
  const empty = { facts: {}, folders: [], files: [], pictures: [], others: [] };
  const root: Folder = { type: "folder", request: 1, path: "", ...empty, records: ["night"] };

  it("opens where it lies, in the folder of the studio", async () => {
    server({ folder: root });
    expect(await takeDropped({ file: new File([], "night"), folder: true })).toBe(true);
    expect(sent).toEqual([
      { type: "list_folder", path: "" },
      { type: "open_file", path: "night" },
    ]);
  });

  it("is refused elsewhere, with the command that opens it", async () => {
    useStudio.setState({ welcome: { root: "/data/models" } as Welcome });
    server({ folder: root });
    expect(await takeDropped({ file: new File([], "other.nc"), folder: false })).toBe(false);
    expect(notices()).toEqual([
      "error: The folder of the studio, /data/models, contains no record other.nc.",
    ]);
    expect(useStudio.getState().notice?.problems[0]?.fix).toMatch(/deodar studio PATH\/other\.nc$/);
    expect(sent).toEqual([{ type: "list_folder", path: "" }]);
  });

  it("is read by the sensors of a document that has some", async () => {
    useStudio.setState({
      clock: { type: "clock", senses: true } as never,
      kinds: new Map([["Recording", { ...picture, name: "Recording", opens: [".nc"] }]]),
    });
    server({});
    expect(await takeDropped({ file: new File(["x"], "night.nc"), folder: false })).toBe(true);
    expect(sent.map(({ type }) => type)).toEqual(["use_world_content"]);
  });

  it("is refused as a zip file", async () => {
    server();
    expect(await takeDropped({ file: new File([], "night.zarr.zip"), folder: false })).toBe(false);
    expect(useStudio.getState().notice?.problems[0]?.fix).toMatch(/^Unpack it/);
    expect(sent).toEqual([]);
  });
});

describe("a dropped file", () => {
  const senses = { type: "clock", senses: true } as never;

  it("is used as a picture if the model has a sensor", async () => {
    useStudio.setState({ clock: senses, kinds: worlds });
    server({});
    expect(await takeFile(new File([new Uint8Array([0, 255, 7])], "a.png", { type: "image/png" }))).toBe(
      true,
    );
    expect(sent).toEqual([{ type: "use_world_content", kind: "Picture", name: "a.png", content: "AP8H" }]);
  });

  it("is refused without a sensor, or if its type is unknown", async () => {
    useStudio.setState({ kinds: worlds });
    server();
    for (const file of [
      new File([], "a.png", { type: "image/png" }),
      new File([], "a.txt", { type: "text/plain" }),
    ]) {
      expect(await takeFile(file)).toBe(false);
      expect(notices()).toEqual([expect.stringContaining(file.name)]);
    }
    const large = new File([], "a.json");
    Object.defineProperty(large, "size", { value: 2 ** 30 });
    expect(await takeFile(large)).toBe(false);
    expect(sent).toEqual([]);
    expect(notices()).toEqual([expect.stringContaining("a.json is larger than")]);
  });
});
