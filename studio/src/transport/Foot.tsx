// The foot of the page: the run, and the moments that can be shown.

import { NeedsServer } from "../widgets/NeedsServer";
import { Timeline } from "../replay/Timeline";
import { StopButton } from "../world/LinkState";
import classes from "./Foot.module.css";
import { Transport } from "./Transport";

export function Foot() {
  return (
    <footer className={classes.foot}>
      <NeedsServer>
        <StopButton />
        <Transport />
        <Timeline />
      </NeedsServer>
    </footer>
  );
}
