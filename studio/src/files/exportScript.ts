// The document as a Python script that makes the same document, written to the folder of downloads.

import { saveFile } from "../plots/export/save";
import { request } from "../socket";
import { useStudio } from "../store";

export async function exportScript(): Promise<void> {
  const { text = "" } = await request({ type: "export_script" });
  if (text !== "") {
    const { title = "" } = useStudio.getState().document ?? {};
    saveFile(new Blob([text], { type: "text/x-python" }), title, "py");
  }
}
