/**
 * A second page without a browser at the same server. It uses the studio's protocol, so that a test
 * reads exact numbers.
 */
import { applied } from "../src/server/applied";
import { decode, type Frame } from "../src/server/frames";
import type {
  Announced,
  Answer,
  RunClock,
  DocumentView,
  ElementView,
  Lost,
  ToPage,
  ToServer,
} from "../src/protocol";
import { valueAt } from "../src/model/values";
import { LiveWorld } from "../src/server/live";

/** Time after which a wait fails; it is not a measurement. */
const MINUTE = 60_000;

interface Stream {
  number: number;
  form?: Announced;
  lost?: Lost;
  frame?: Frame;
}

/** The address of a studio's socket, with the token of the address that it printed. */
export function socketOf(url: string): string {
  const there = new URL(url);
  return new URL(`/ws${there.search}`, there).href.replace(/^http/, "ws");
}

export class Observer {
  document: DocumentView | null = null;
  clock: RunClock | undefined;
  /** The world from above, with its bodies after `watch_world`. */
  readonly world = new LiveWorld();
  /** Waits until the page beside this observer has drawn. */
  drawn: () => Promise<void> = async () => {};
  private session = 0;
  private last = 0;
  /** Whether the clock is older than the newest answer: a clock ends each group of messages. */
  private late = false;
  private ended = "";
  private streams = new Map<string, Stream>();
  private answers = new Map<number, Answer>();
  private waiting = new Set<() => void>();

  private constructor(private socket: WebSocket) {
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.takeFrame(decode(data));
      else this.take(JSON.parse(data as string) as ToPage);
      this.tell();
    };
    socket.onclose = () => {
      this.ended = "the connection ended";
      this.tell();
    };
  }

  /** Connect to the server at the address that it printed. */
  static async connect(url: string): Promise<Observer> {
    const observer = new Observer(new WebSocket(socketOf(url)));
    await observer.until(() => observer.clock !== undefined);
    return observer;
  }

  close(): void {
    this.socket.close();
  }

  /**
   * Wait until a condition holds, and until the page has drawn what it received by then. The condition is
   * evaluated after each message; the wait fails after some minutes.
   */
  async until(condition: () => unknown, minutes = 3): Promise<void> {
    await this.holds(condition, minutes);
    await this.drawn();
  }

  private holds(condition: () => unknown, minutes: number): Promise<void> {
    return new Promise((resolve, reject) => {
      const done = (how: () => void) => {
        clearTimeout(timer);
        this.waiting.delete(look);
        how();
      };
      const fail = (why: string) =>
        done(() => reject(new Error(`${why}, and never held: ${condition}. ${this.situation()}`)));
      const look = () => {
        try {
          if (condition()) done(resolve);
          else if (this.ended !== "") fail(this.ended);
        } catch (error) {
          done(() => reject(error as Error));
        }
      };
      const timer = setTimeout(fail, minutes * MINUTE, `${minutes} min went by`);
      this.waiting.add(look);
      look();
    });
  }

  /** Send a request and wait for the answer. */
  async ask(message: ToServer): Promise<Answer> {
    const request = ++this.last;
    this.say({ ...message, request } as ToServer);
    await this.until(() => this.answers.has(request) && !this.late);
    return this.answers.get(request) as Answer;
  }

  /** Wait until a document is open and compiled. */
  runs(): Promise<void> {
    return this.until(
      () => this.document !== null && this.clock?.busy === "" && (this.clock?.failure ?? []).length === 0,
    );
  }

  get running(): boolean {
    return this.clock?.running ?? false;
  }

  /** Simulated time. */
  get time(): number {
    return this.clock?.time ?? Number.NaN;
  }

  element(path: string): ElementView {
    const found = this.document?.elements.find((element) => element.path === path);
    if (!found)
      throw new Error(
        `unknown path ${path}. Valid paths: ${this.document?.elements.map((one) => one.path).join(", ")}`,
      );
    return found;
  }

  /** A parameter of an element in the document, such as kernel.0.sigma. */
  value(path: string, parameter: string): unknown {
    return valueAt(this.element(path).values, parameter);
  }

  /** The values of a port in the newest frame; none before the first frame. */
  values(path: string, port: string): Float32Array {
    const key = `${path}.${port}`;
    let stream = this.streams.get(key);
    if (!stream) {
      stream = { number: ++this.last };
      this.streams.set(key, stream);
      this.say({ type: "watch", stream: stream.number, element: this.element(path).id, port, most: 0 });
    }
    return stream.frame?.values ?? new Float32Array();
  }

  /** The simulated time of the newest frame. */
  moment(path: string, port: string): number {
    return this.streams.get(`${path}.${port}`)?.frame?.time ?? Number.NaN;
  }

  /** The largest value; NaN before the first frame, so that no comparison holds. */
  max(path: string, port: string): number {
    const values = this.values(path, port);
    return values.length === 0 ? Number.NaN : values.reduce((most, value) => Math.max(most, value));
  }

  /** The index of the largest value. */
  peak(path: string, port: string): number {
    return this.values(path, port).indexOf(this.max(path, port));
  }

  private say(message: ToServer): void {
    this.socket.send(JSON.stringify(message));
  }

  private take(message: ToPage): void {
    switch (message.type) {
      case "opened":
        this.document = message.document;
        if (message.session !== this.session) {
          for (const { number } of this.streams.values()) this.say({ type: "unwatch", stream: number });
          this.streams.clear();
          this.clock = undefined; // the clock of the document before
        }
        this.session = message.session;
        break;
      case "edited":
        if (this.document !== null) this.document = applied(this.document, message.difference);
        break;
      case "checked":
        if (this.document !== null) this.document = { ...this.document, problems: message.problems };
        break;
      case "announced":
      case "lost": {
        const stream = [...this.streams.values()].find(({ number }) => number === message.stream);
        if (stream)
          Object.assign(stream, message.type === "lost" ? { lost: message } : { form: message }, {
            frame: undefined,
          });
        break;
      }
      case "answer":
        this.answers.set(message.request, message);
        this.late = true;
        break;
      case "scene":
      case "robot_link":
      case "solids":
      case "bodies":
        this.world.take(message);
        break;
      case "clock":
        this.clock = message;
        this.late = false;
        this.say({ type: "drawn", frame: message.frame });
        break;
    }
  }

  private takeFrame(frame: Frame): void {
    const stream = [...this.streams.values()].find(({ number }) => number === frame.stream);
    if (stream) stream.frame = frame;
  }

  private tell(): void {
    for (const look of [...this.waiting]) look();
  }

  private situation(): string {
    const seen = [...this.streams].map(([key, { frame, lost }]) => {
      const values = [...(frame?.values ?? [])];
      return `${key} ${lost ? lost.problem.what : `${values.length} values, at most ${Math.max(...values)}`}`;
    });
    return `Clock: ${JSON.stringify(this.clock)}. Seen: ${seen.join("; ")}.`;
  }
}
