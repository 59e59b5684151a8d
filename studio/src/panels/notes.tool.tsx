// The notes of the document to read. They are changed in the inspector.

import type { DockTool } from "../state/tool";
import { useStudio } from "../store";
import classes from "./notes.module.css";

export const tool: DockTool = { title: "Notes", tab: 4, component: Notes };

function Notes() {
  const notes = useStudio((state) => state.document?.notes ?? "");
  return (
    <div className={classes.notes} role="document" aria-label="Notes of the document" tabIndex={0}>
      {notes === "" ? (
        <p>This document has no notes. Write them in the inspector, with no element selected.</p>
      ) : (
        notes
      )}
    </div>
  );
}
