// Before the first message of the server, and while the connection is lost: the page stays as it was then.

import { IconPlugConnectedX } from "@tabler/icons-react";

import { Logo } from "../widgets/Logo";
import { useStudio } from "../server/store";
import classes from "../widgets/connection.module.css";

const REFUSED = "The studio was started again: open the address that it printed";
const BEFORE = {
  connecting: "Connecting",
  open: "Connecting",
  lost: "The studio does not answer. Is deodar studio running?",
  refused: REFUSED,
};

export function Splash() {
  const connection = useStudio((state) => state.connection);
  return (
    <main className={classes.splash} aria-busy="true">
      <Logo size={56} color="var(--edge)" />
      <p role="status">{BEFORE[connection]}</p>
    </main>
  );
}

export function LostBanner() {
  const connection = useStudio((state) => (state.welcome === null ? "connecting" : state.connection));
  return (
    <div role="status">
      {(connection === "lost" || connection === "refused") && (
        <div className={`banner ${classes.lost}`}>
          <IconPlugConnectedX size={16} aria-hidden="true" />
          {connection === "lost" ? "Connection lost, trying again" : REFUSED}
        </div>
      )}
    </div>
  );
}
