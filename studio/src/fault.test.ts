// An error of deodar itself is offered as a fault report; a refusal is not.

import { beforeEach, expect, test, vi } from "vitest";

import { fresh, notices, sent, server } from "./files/scripted";
import { saveFile } from "./plots/export/save";
import { request } from "./socket";
import { useStudio } from "./store";

vi.mock("./plots/export/save", () => ({ saveFile: vi.fn() }));
beforeEach(fresh);

const offer = () => useStudio.getState().notices[0]?.offer;

test("an error of deodar itself offers the text of a fault report", async () => {
  const what = "This is an error of deodar itself (KeyError: 'x').";
  server({ problems: [{ what }], fault: true }, { text: "deodar 0.2.0 on Python 3.11" });
  await request({ type: "undo" });
  expect(notices()).toEqual([`error: ${what}`]);
  expect(offer()?.label).toBe("Save a fault report");
  await offer()?.run();
  expect(sent.map((message) => message.type)).toEqual(["undo", "fault_report"]);
  const [blob, title, suffix] = vi.mocked(saveFile).mock.calls[0] ?? [];
  expect([await blob?.text(), title, suffix]).toEqual(["deodar 0.2.0 on Python 3.11", "fault-report", "txt"]);
});

test("a refusal offers no report", async () => {
  server({ problems: [{ what: "There is nothing to undo." }] });
  await request({ type: "undo" });
  expect(offer()).toBeUndefined();
});
