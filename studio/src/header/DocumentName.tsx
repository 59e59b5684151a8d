// What is open: its title, where it is kept, and whether it was edited since.

import { useEffect } from "react";

import { useStudio } from "../server/store";
import classes from "./header.module.css";

export function DocumentName() {
  const title = useStudio((state) => state.document?.title ?? "");
  const file = useStudio((state) => state.document?.record?.path ?? state.document?.file ?? "");
  const unsaved = useStudio((state) => state.document?.unsaved ?? false);
  useEffect(() => {
    document.title = `${unsaved ? "● " : ""}${title} – deodar studio`;
    return () => {
      document.title = "deodar studio";
    };
  }, [title, unsaved]);
  return (
    <div className={classes.name}>
      <div className="across">
        <h1 className="one-line" title={title}>
          {title}
        </h1>
        {unsaved && (
          <span className={classes.dot} role="img" aria-label="Unsaved edits" title="Unsaved edits" />
        )}
      </div>
      <div className="one-line dim" title={file}>
        {file === "" ? "not in a file yet" : file}
      </div>
    </div>
  );
}
