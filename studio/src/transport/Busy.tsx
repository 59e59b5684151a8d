// The present background task, such as a new program. Its space is reserved, so that nothing moves.

import { Loader } from "@mantine/core";

import { useStudio } from "../store";
import classes from "./Busy.module.css";

export function Busy() {
  const busy = useStudio((state) => state.clock?.busy ?? "");
  return (
    <div className={classes.busy} role="status" title={busy}>
      {busy !== "" && (
        <>
          <Loader size={14} aria-hidden="true" />
          <span className={`${classes.text} one-line`}>{busy}</span>
        </>
      )}
    </div>
  );
}
