/**
 * WebKit, as the MiniBrowser of WebKitGTK, driven by WebDriver. It has no headless mode: an X server without
 * a screen (Xvfb) takes its window.
 */
import { type ChildProcess, spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { createServer } from "node:net";

import { type Button, type Driver, programOf } from "./driver";

const PATIENCE = 30_000;
const SIZE = { width: 1280, height: 900 };
const BUTTONS: Record<Button, number> = { left: 0, right: 2 };
const KEYS: Record<string, string> = { Control: "\uE009", Enter: "\uE007", Escape: "\uE00C" };
const LOCALE = "en_US.UTF-8";

export async function launchWebkit(): Promise<Driver> {
  const [screen, display] = await startScreen();
  const port = await freePort();
  const driver = spawn(programOf("DEODAR_WEBKIT"), [`--port=${port}`], {
    stdio: "ignore",
    env: {
      ...process.env,
      DISPLAY: display,
      GDK_BACKEND: "x11",
      // layers composed without a GPU take several times as long
      WEBKIT_DISABLE_COMPOSITING_MODE: "1",
      LIBGL_ALWAYS_SOFTWARE: "1",
      // under the locale C the language of the page is "C", which is none
      LANGUAGE: "en_US",
      LC_ALL: LOCALE,
      // its sandbox needs rights that a container does not give
      WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: "1",
    },
  });
  const stop = () => {
    for (const one of [driver, screen]) one.kill("SIGKILL");
  };
  process.once("exit", stop);

  const call = async (method: string, path: string, body?: object): Promise<unknown> => {
    const answer = await fetch(`http://127.0.0.1:${port}${path}`, {
      method,
      ...(body ? { body: JSON.stringify(body) } : {}),
    });
    const { value } = (await answer.json()) as { value: unknown };
    if (!answer.ok) throw new Error(`WebKit refused ${path}: ${JSON.stringify(value)}`);
    return value;
  };
  try {
    await until(async () => {
      await call("GET", "/status");
    });
    const capabilities = { alwaysMatch: { browserName: "MiniBrowser" } };
    const { sessionId } = (await call("POST", "/session", { capabilities })) as { sessionId: string };
    const here = `/session/${sessionId}`;
    await call("POST", `${here}/window/rect`, SIZE);
    return driven((method, path, body) => call(method, `${here}${path}`, body), stop);
  } catch (error) {
    stop();
    throw error;
  }
}

const to = (x: number, y: number): object => ({
  type: "pointerMove",
  duration: 100,
  x: Math.round(x),
  y: Math.round(y),
});
const pressed = (button: Button = "left"): object => ({ type: "pointerDown", button: BUTTONS[button] });
const released = (button: Button = "left"): object => ({ type: "pointerUp", button: BUTTONS[button] });

/** A driver whose commands are sent to one session. */
function driven(
  call: (method: string, path: string, body?: object) => Promise<unknown>,
  stop: () => void,
): Driver {
  const evaluate: Driver["evaluate"] = async (look, argument) =>
    (await call("POST", "/execute/sync", {
      script: `return (${look.toString()})(arguments[0]);`,
      args: [argument],
    })) as ReturnType<typeof look>;
  const pointer = (...actions: object[]) =>
    call("POST", "/actions", {
      actions: [{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }],
    }) as Promise<void>;
  const keys = (...actions: [type: "keyDown" | "keyUp", key: string][]) =>
    call("POST", "/actions", {
      actions: [
        {
          type: "key",
          id: "keyboard",
          actions: actions.map(([type, key]) => ({ type, value: KEYS[key] ?? key })),
        },
      ],
    }) as Promise<void>;
  return {
    open: async (url) => {
      await call("POST", "/url", { url });
      await evaluate(listen, null);
    },
    evaluate,
    move: (x, y) => pointer(to(x, y)),
    down: (button) => pointer(pressed(button)),
    up: async (button) => {
      await pointer(released(button));
      // this driver sends the page no event for a release of the right button; leaving a plot ends it too
      if (button === "right") await pointer(to(0, 0));
    },
    doubleClick: (x, y) => pointer(to(x, y), pressed(), released(), pressed(), released()),
    press: (key, modifier) =>
      modifier
        ? keys(["keyDown", modifier], ["keyDown", key], ["keyUp", key], ["keyUp", modifier])
        : keys(["keyDown", key], ["keyUp", key]),
    picture: async (path) =>
      writeFileSync(path, Buffer.from((await call("GET", "/screenshot")) as string, "base64")),
    errors: () => evaluate(() => (window as unknown as { reported?: string[] }).reported ?? [], null),
    close: async () => {
      await call("DELETE", "");
      stop();
    },
  };
}

/** In the page: note its errors. */
function listen(): void {
  const reported: string[] = [];
  (window as unknown as { reported: string[] }).reported = reported;
  addEventListener("error", ({ message }) => reported.push(message));
  addEventListener("unhandledrejection", ({ reason }) => reported.push(String(reason)));
  const { error } = console;
  console.error = (...said) => {
    reported.push(said.join(" "));
    error(...said);
  };
}

/** An X server without a screen, and its display, whose number it chooses and writes. */
async function startScreen(): Promise<[ChildProcess, string]> {
  const screen = spawn(
    "Xvfb",
    ["-displayfd", "3", "-screen", "0", `${SIZE.width}x${SIZE.height}x24`, "-nolisten", "tcp"],
    { stdio: ["ignore", "ignore", "ignore", "pipe"] },
  );
  const number = await new Promise<string>((resolve, reject) => {
    screen.once("error", reject);
    screen.once("exit", (status) => reject(new Error(`Xvfb ended with status ${status}.`)));
    screen.stdio[3]?.once("data", (text: Buffer) => resolve(text.toString().trim()));
  });
  return [screen, `:${number}`];
}

function freePort(): Promise<number> {
  return new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const address = server.address();
      const port = typeof address === "object" ? (address?.port ?? 0) : 0;
      server.close(() => resolve(port));
    });
  });
}

async function until(act: () => Promise<void>): Promise<void> {
  const end = Date.now() + PATIENCE;
  for (;;) {
    try {
      return await act();
    } catch (error) {
      if (Date.now() > end) throw error;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }
}
