// An error of deodar itself is offered as a fault report; a refusal is not.

import { beforeEach, expect, test, vi } from "vitest";

import { fresh, notices, sent, server } from "../files/scripted";
import { saveFile } from "./save";
import { request } from "./socket";
import { useStudio } from "./store";

vi.mock("./save", () => ({ saveFile: vi.fn() }));
beforeEach(fresh);

const offers = () => useStudio.getState().notice?.offers ?? [];
const press = (label: string) =>
  offers()
    .find((offer) => offer.label === label)
    ?.run();
const what = "This is an error of deodar itself (KeyError: 'x').";
const text = "deodar 0.2.0 on Python 3.11";

test("an error of deodar itself says what failed, and has the details and a report", async () => {
  const writeText = vi.fn();
  vi.stubGlobal("navigator", { clipboard: { writeText } });
  server({ problems: [{ what }], fault: true }, { text });
  await request({ type: "apply_preset", path: "a.json" });
  expect(notices()).toEqual(["error: Apply preset failed."]);
  expect(offers().map(({ label }) => label)).toEqual(["Copy the report", "Details"]);
  press("Details");
  expect(notices()).toEqual([`error: ${what}`]);
  await press("Copy the report");
  expect(writeText).toHaveBeenCalledExactlyOnceWith(text);
  expect(sent.map((message) => message.type)).toEqual(["apply_preset", "fault_report"]);
});

test("a page that may not write to the clipboard saves the report", async () => {
  vi.stubGlobal("navigator", {});
  server({ problems: [{ what }], fault: true }, { text });
  await request({ type: "undo" });
  await press("Copy the report");
  const [blob, title, suffix] = vi.mocked(saveFile).mock.calls[0] ?? [];
  expect([await blob?.text(), title, suffix]).toEqual([text, "fault-report", "txt"]);
});

test("a refusal offers no report, and all its problems are one message", async () => {
  server({ problems: [{ what: "no tau" }, { what: "no axes" }] });
  await request({ type: "undo" });
  expect(notices()).toEqual(["error: no tau", "error: no axes"]);
  expect(offers()).toEqual([]);
});
