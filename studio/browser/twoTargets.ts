import { runScript } from "./server";

/** Write `two-targets.json` with its model into a folder. */
export async function writeTwoTargets(folder: string): Promise<void> {
  await runScript("two_targets", folder);
}
