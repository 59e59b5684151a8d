// A file dropped anywhere: a document or a record is opened, a picture is shown to the sensors.

import { useEffect, useState } from "react";

import { useStudio } from "../store";
import { useDialogs } from "../dialogs/questions";
import { takeDropped } from "./flows";
import classes from "./DropArea.module.css";

export function DropArea() {
  const [over, setOver] = useState(false);
  const senses = useStudio((state) => state.clock?.senses ?? false);
  useEffect(() => {
    // Panels are dragged in the same way; only files of the person's own concern us.
    const files = (event: DragEvent) => event.dataTransfer?.types.includes("Files") === true;
    const drag = (event: DragEvent) => {
      if (files(event)) {
        event.preventDefault();
        event.stopPropagation();
        setOver(event.type !== "dragleave" || event.relatedTarget !== null);
      }
    };
    const drop = (event: DragEvent) => {
      if (files(event)) {
        event.preventDefault();
        event.stopPropagation();
        setOver(false);
        const file = event.dataTransfer?.files[0];
        if (file !== undefined) {
          useDialogs.getState().cancel();
          // Only now, during the event, the browser says whether it is a folder.
          const folder = event.dataTransfer?.items[0]?.webkitGetAsEntry()?.isDirectory === true;
          void takeDropped({ file, folder });
        }
      }
    };
    const capture = { capture: true };
    addEventListener("dragenter", drag, capture);
    addEventListener("dragover", drag, capture);
    addEventListener("dragleave", drag, capture);
    addEventListener("drop", drop, capture);
    return () => {
      removeEventListener("dragenter", drag, capture);
      removeEventListener("dragover", drag, capture);
      removeEventListener("dragleave", drag, capture);
      removeEventListener("drop", drop, capture);
    };
  }, []);
  if (!over) {
    return null;
  }
  return (
    <div className={classes.area} aria-hidden="true">
      <div className={classes.text}>
        Drop a document or a record to open it{senses && ", or a picture to show it to the sensors"}
      </div>
    </div>
  );
}
