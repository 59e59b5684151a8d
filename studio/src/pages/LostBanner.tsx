// While the connection is lost: the page stays as it was, to look at.

import { IconPlugConnectedX } from "@tabler/icons-react";

import { useStudio } from "../store";
import classes from "./LostBanner.module.css";

export function LostBanner() {
  const lost = useStudio((state) => state.connection === "lost" && state.welcome !== null);
  return (
    <div role="status">
      {lost && (
        <div className={classes.banner}>
          <IconPlugConnectedX size={16} aria-hidden="true" />
          Connection lost, trying again
        </div>
      )}
    </div>
  );
}
