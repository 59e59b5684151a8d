// Before the server has said anything.

import { useStudio } from "../store";
import { Mark } from "./Mark";
import classes from "./Splash.module.css";

export function Splash() {
  const lost = useStudio((state) => state.connection === "lost");
  return (
    <main className={classes.splash} aria-busy="true">
      <Mark size={56} color="var(--border-strong)" />
      <p role="status">{lost ? "Nothing answers. Is deodar studio running?" : "Connecting"}</p>
    </main>
  );
}
