// The notes of the document to read, as wide as they need. They are changed in the inspector.

import { useStudio } from "../store";
import classes from "./NotesDialog.module.css";

export function NotesDialog() {
  const notes = useStudio((state) => state.document?.notes ?? "");
  return (
    <div
      className={classes.notes}
      role="document"
      aria-label="Notes of the document"
      tabIndex={0}
      data-autofocus
    >
      {notes}
    </div>
  );
}
