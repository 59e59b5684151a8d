// Controls that need the server: without a connection they are disabled, and show what the server sent last.

import { Fragment, type ReactNode } from "react";

import { useStudio } from "../server/store";
import classes from "./connection.module.css";

export function NeedsServer({ children }: { children: ReactNode }) {
  const off = useOffline();
  // With each loss the controls begin again: what was typed into them and not sent is dropped.
  const losses = useStudio((state) => state.losses);
  return (
    <fieldset className={classes.controls} disabled={off}>
      <Fragment key={losses}>{children}</Fragment>
    </fieldset>
  );
}

export function useOffline(): boolean {
  return useStudio((state) => state.connection !== "open");
}
