/** How much a page in a real browser slows down an engine that runs at full speed. */
import { curves } from "./documents";
import { socketOf } from "../observer";
import { median } from "./figures";
import { onStage, type Stage } from "./stage";

const SETTLE_MS = 2500;
const CLOCKS = 5;
const PAUSE_MS = 600;

/**
 * Steps per second without an open page, and the loss in percent with four plots in a browser, in
 * alternation.
 */
export async function slowed(rounds: number): Promise<{ free: number; percent: number }> {
  const free: number[] = [];
  const percent: number[] = [];
  await onStage(curves(4), async (stage) => {
    const socket = await connected(stage);
    for (let i = 0; i < rounds; i++) {
      const alone = await steps(socket);
      const page = await stage.open();
      await page.locator(".plot-host > .plot-canvas").nth(3).waitFor();
      const watched = await steps(socket);
      await page.context().close();
      free.push(alone);
      percent.push(100 * (1 - watched / alone));
    }
    socket.close();
  });
  return { free: median(free), percent: median(percent) };
}

interface Observer {
  clock: () => Promise<number>;
  close: () => void;
}

/**
 * A page without a screen, which reads the clock only on request; from now on the engine runs at full
 * speed.
 */
async function connected({ server }: Stage): Promise<Observer> {
  const socket = new WebSocket(socketOf(server.url));
  const say = (message: object) => socket.send(JSON.stringify(message));
  let frame = 0;
  let opened = false;
  let told: ((steps: number) => void) | null = null;
  const ready = new Promise<void>((done, fail) => {
    socket.onerror = () => fail(new Error("no connection to the studio"));
    socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return;
      const message = JSON.parse(data) as {
        type: string;
        frame: number;
        steps: number;
        document: object | null;
      };
      opened ||= message.type === "opened" && message.document !== null;
      if (message.type !== "clock") return;
      frame = message.frame;
      if (!opened) say({ type: "drawn", frame });
      else done();
      told?.(message.steps);
      told = null;
    };
  });
  await ready;
  say({ type: "speed", factor: null });
  say({ type: "play" });
  const clock = () =>
    new Promise<number>((done) => {
      told = done;
      say({ type: "drawn", frame });
    });
  return { clock, close: () => socket.close() };
}

async function steps(observer: Observer): Promise<number> {
  await pause(SETTLE_MS);
  const found: number[] = [];
  await observer.clock(); // a message from before
  for (let i = 0; i < CLOCKS; i++) {
    await pause(PAUSE_MS);
    found.push(await observer.clock());
  }
  return median(found);
}

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));
