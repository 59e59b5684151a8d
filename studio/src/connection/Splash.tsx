// Shown before the first message of the server.

import { useStudio } from "../store";
import { Logo } from "../gallery/Logo";
import classes from "./Splash.module.css";

const WORDS = {
  connecting: "Connecting",
  open: "Connecting",
  lost: "The studio does not answer. Is deodar studio running?",
  refused: "The studio was started again: open the address that it printed",
};

export function Splash() {
  const connection = useStudio((state) => state.connection);
  return (
    <main className={classes.splash} aria-busy="true">
      <Logo size={56} color="var(--edge)" />
      <p role="status">{WORDS[connection]}</p>
    </main>
  );
}
