import { runScript } from "./server";

/** Write `two-targets.json` with its model into a folder. */
export function writeTwoTargets(folder: string): void {
  runScript("two_targets", folder);
}
