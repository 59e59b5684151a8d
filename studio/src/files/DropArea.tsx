// A file dropped anywhere: a document or a record is opened, a picture is shown to the sensors.

import { useEffect, useState } from "react";

import { useStudio } from "../server/store";
import { useDialogs } from "../state/questions";
import { takeDropped } from "./flows";
import classes from "./files.module.css";

export function DropArea() {
  const [over, setOver] = useState(false);
  const senses = useStudio((state) => state.clock?.senses ?? false);
  useEffect(() => {
    // Panels are dragged in the same way; only files of the person's own concern us.
    const drag = (event: DragEvent) => {
      const { dataTransfer, type, relatedTarget } = event;
      if (!dataTransfer?.types.includes("Files")) {
        return;
      }
      event.preventDefault();
      event.stopPropagation();
      setOver(type !== "drop" && (type !== "dragleave" || relatedTarget !== null));
      const file = dataTransfer.files[0];
      if (type === "drop" && file !== undefined) {
        useDialogs.getState().cancel();
        // Only now, during the event, the browser says whether it is a folder.
        const folder = dataTransfer.items[0]?.webkitGetAsEntry()?.isDirectory === true;
        void takeDropped({ file, folder });
      }
    };
    const events = ["dragenter", "dragover", "dragleave", "drop"] as const;
    events.forEach((name) => addEventListener(name, drag, { capture: true }));
    return () => events.forEach((name) => removeEventListener(name, drag, { capture: true }));
  }, []);
  if (!over) {
    return null;
  }
  return (
    <div className={classes.area} aria-hidden="true">
      <div>Drop a document or a record to open it{senses && ", or a picture to show it to the sensors"}</div>
    </div>
  );
}
