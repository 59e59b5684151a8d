// A plot of the open record, and beside it the same plot of the record that it is compared with.

import type { ReactNode } from "react";

import { lastPart } from "../model/paths";
import { useStudio } from "../server/store";
import { OtherRecord } from "../state/OtherRecord";
import classes from "./Comparison.module.css";

export function SideBySide({ children }: { children: ReactNode }) {
  const one = useStudio((state) => state.document?.record?.path ?? "");
  const other = useStudio((state) => state.comparison?.path ?? "");
  return (
    <div className={classes.pair}>
      <Half path={one}>{children}</Half>
      <OtherRecord value={true}>
        <Half path={other}>{children}</Half>
      </OtherRecord>
    </div>
  );
}

function Half({ path, children }: { path: string; children: ReactNode }) {
  return (
    <section className={classes.half} aria-label={`Record ${path}`}>
      <div className={`${classes.name} one-line`} title={path}>
        {lastPart(path)}
      </div>
      <div className={classes.plot}>{children}</div>
    </section>
  );
}
