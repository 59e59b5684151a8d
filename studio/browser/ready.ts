import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { launch } from "./chromium";
import { FORKING, python } from "./server";

/**
 * Start a browser before the first test, so that a failure is reported once, not by every test; and a process
 * that forks for each server, where the system can fork.
 */
export default async function setup(): Promise<(() => void) | undefined> {
  const browser = await launch();
  await browser.close();
  if (process.platform === "win32") return undefined;

  const folder = mkdtempSync(join(tmpdir(), "deodar-forking-"));
  const path = join(folder, "socket");
  const child = spawn(python(), [join(import.meta.dirname, "python", "forking.py"), path], {
    stdio: ["pipe", "inherit", "inherit"],
    env: { ...process.env, PYTHONUNBUFFERED: "1" },
  });
  while (!existsSync(path)) {
    if (child.exitCode !== null) throw new Error(`forking.py ended with status ${child.exitCode}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  process.env[FORKING] = path;
  return () => {
    child.stdin.end();
    rmSync(folder, { recursive: true, force: true });
  };
}
