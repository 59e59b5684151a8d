// What is missing in the open record, below the slider.

import { IconAlertTriangle } from "@tabler/icons-react";

import { useStudio } from "../server/store";
import classes from "./RecordNotes.module.css";

const NONE: string[] = [];

export function RecordNotes() {
  const notes = useStudio((state) => state.document?.record?.notes ?? NONE);
  if (notes.length === 0) {
    return null;
  }
  return (
    <div className={classes.notes} role="status" aria-label="Notes on the record">
      <IconAlertTriangle size={16} aria-hidden="true" />
      <div>
        {notes.map((note) => (
          <div key={note}>{note}</div>
        ))}
      </div>
    </div>
  );
}
