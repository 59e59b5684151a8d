// While the connection is lost: the page stays as it was, to look at.

import { IconPlugConnectedX } from "@tabler/icons-react";

import { useStudio } from "../store";
import classes from "./LostBanner.module.css";

export function LostBanner() {
  const connection = useStudio((state) => (state.welcome === null ? "connecting" : state.connection));
  return (
    <div role="status">
      {(connection === "lost" || connection === "refused") && (
        <div className={classes.banner}>
          <IconPlugConnectedX size={16} aria-hidden="true" />
          {connection === "lost"
            ? "Connection lost, trying again"
            : "The studio was started again: open the address that it printed"}
        </div>
      )}
    </div>
  );
}
