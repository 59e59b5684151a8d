// The present background task, such as a new program. Its space is reserved, so that nothing moves.

import { Loader } from "@mantine/core";

import { useStudio } from "../server/store";
import classes from "./Busy.module.css";
import { compilingText } from "../model/format";

export function Busy() {
  const busy = useStudio((state) => state.clock?.busy ?? "");
  const compiling = useStudio((state) => state.clock?.compiling ?? null);
  const time = compiling === null ? "" : compilingText(compiling);
  const phase = compiling?.phase ?? busy;
  return (
    <div
      className={`${classes.busy} dim`}
      role="status"
      title={busy === "" ? "" : `${phase} ${time}`.trimEnd()}
    >
      {busy !== "" && (
        <>
          <Loader size={14} aria-hidden="true" />
          <div className={`${classes.text} numbers`}>
            <div className="one-line">{phase}</div>
            <div className={"fine one-line"}>{time}</div>
          </div>
        </>
      )}
    </div>
  );
}
