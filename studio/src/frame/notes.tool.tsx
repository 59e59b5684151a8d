// The notes of the document to read. They are changed in the inspector.

import type { DockTool } from "../state/tool";
import { useStudio } from "../server/store";
import classes from "./notes.module.css";

export const tool: DockTool = { title: "Notes", tab: 4, component: Notes };

const NO_NOTES = "This document has no notes. Write them in the inspector, with no element selected.";

function Notes() {
  const notes = useStudio((state) => state.document?.notes ?? "");
  return (
    <div
      className={`wrapped ${classes.notes}`}
      role="document"
      aria-label="Notes of the document"
      tabIndex={0}
    >
      {notes || <span className="dim">{NO_NOTES}</span>}
    </div>
  );
}
