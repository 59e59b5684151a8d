/** `deodar studio` in folders of its own, as a user starts it. */
import { execFile, spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { connect } from "node:net";
import { join } from "node:path";
import type { Readable } from "node:stream";
import { promisify } from "node:util";

const ROOT = join(import.meta.dirname, "..", "..");
const ADDRESS = /http:\/\/127\.0\.0\.1:\d+\S*(?=\s)/;
/** Time in ms after which a wait fails; it is not a measurement: others may take most of the machine. */
export const PATIENCE = 180_000;
const GRACE = 10_000;

export interface ServerOptions {
  /** The document to open, relative to the working folder; without one, the gallery. */
  file?: string;
  /** Python modules in the working folder that are imported first. */
  imports?: string[];
  /** Further arguments of the command line. */
  words?: string[];
}

export interface Server {
  url: string;
  /** The output so far. */
  said: () => string;
  stop: (signal?: NodeJS.Signals) => Promise<void>;
}

/** The Python that has deodar: the one that runs the tests, or the one of the environment in .venv. */
export function python(): string {
  const named = process.env["DEODAR_PYTHON"];
  if (named) return named;
  const found = ["bin/python", "Scripts/python.exe"]
    .map((name) => join(ROOT, ".venv", name))
    .find((path) => existsSync(path));
  if (!found)
    throw new Error(
      "No .venv with deodar was found. Type `make test`, or set DEODAR_PYTHON to a Python that has deodar.",
    );
  return found;
}

/**
 * Run Python with these arguments, and return what it prints. Connections to a studio are answered meanwhile:
 * it would end them.
 */
export async function runPython(words: string[], folder?: string, env?: NodeJS.ProcessEnv): Promise<string> {
  const options = { cwd: folder, env: { ...process.env, ...env } };
  return (await promisify(execFile)(python(), words, options)).stdout;
}

/** Run `browser/python/NAME.py` in a folder, and return what it prints. */
export const runScript = (name: string, folder?: string): Promise<string> =>
  runPython([join(import.meta.dirname, "python", `${name}.py`)], folder);

interface Child {
  output: Readable[];
  kill: (signal: NodeJS.Signals) => void;
  /** How it ended. */
  ended: Promise<string>;
}

type Start = (words: string[], folder: string, env: NodeJS.ProcessEnv) => Promise<Child>;

const spawned: Start = async (words, folder, env) => {
  const child = spawn(python(), ["-m", "deodar", ...words], {
    cwd: folder,
    env,
    stdio: ["ignore", "pipe", "pipe"],
  });
  const ended = new Promise<string>((resolve) => {
    child.once("error", (error) => resolve(`did not start (${error.message})`));
    child.once("close", (status) => resolve(`ended with status ${status}`));
  });
  return { output: [child.stdout, child.stderr], kill: (signal) => child.kill(signal), ended };
};

/** Name of the environment variable with the socket of `forking.py`, where a start takes no import. */
export const FORKING = "DEODAR_FORKING";

const forked: Start = async (words, folder, env) => {
  const socket = connect(process.env[FORKING] ?? "");
  const ended = new Promise<string>((resolve) => {
    socket.once("error", (error) => resolve(`did not start (${error.message})`));
    socket.once("close", () => resolve("ended"));
  });
  socket.write(`${JSON.stringify({ words, folder, env })}\n`);
  const number = await new Promise<number>((resolve, reject) => {
    // the first line was sent alone, but may arrive with output behind it
    socket.once("data", (piece) => {
      socket.pause();
      const end = piece.indexOf("\n");
      socket.unshift(piece.subarray(end + 1));
      resolve(Number(piece.subarray(0, end).toString()));
    });
    void ended.then((how) => reject(new Error(`deodar studio ${how}`)));
  });
  const kill = (signal: NodeJS.Signals) => {
    // a process that has ended has no number any more
    if (!socket.closed) process.kill(number, signal);
  };
  return { output: [socket], kill, ended };
};

/** Start a server and wait until it listens. It works in `folder` and stores unsaved edits in `state`. */
export async function startServer(
  folder: string,
  state: string,
  options: ServerOptions = {},
): Promise<Server> {
  const imports = (options.imports ?? []).flatMap((name) => ["--import", name]);
  const file = options.file ? [options.file] : [];
  const words = [...imports, "studio", ...file, "--no-browser", "--port", "0", ...(options.words ?? [])];
  const env = {
    // tests share compiled programs
    DEODAR_CACHE: join(ROOT, ".pytest_cache", "programs"),
    ...process.env,
    DEODAR_STATE: state,
    PYTHONUNBUFFERED: "1",
    COLUMNS: "400",
    NO_COLOR: "1",
  };
  const child = await (process.env[FORKING] ? forked : spawned)(words, folder, env);
  const orphan = () => child.kill("SIGKILL");
  process.once("exit", orphan);

  let text = "";
  let timer: NodeJS.Timeout | undefined;
  const url = await new Promise<string>((resolve, reject) => {
    const fail = (why: string) => {
      child.kill("SIGKILL");
      reject(new Error(`deodar studio ${why}. It said:\n${text}`));
    };
    timer = setTimeout(fail, PATIENCE, "printed no address");
    void child.ended.then((how) => fail(how));
    for (const stream of child.output) {
      stream.setEncoding("utf8").on("data", (piece: string) => {
        text += piece;
        const found = ADDRESS.exec(text);
        if (found) resolve(found[0]);
      });
      stream.resume();
    }
  }).finally(() => clearTimeout(timer));

  const stop = async (signal: NodeJS.Signals = "SIGTERM") => {
    child.kill(signal);
    const impatient = setTimeout(orphan, GRACE);
    await child.ended;
    clearTimeout(impatient);
    process.removeListener("exit", orphan);
  };
  return { url, said: () => text, stop };
}
