// The one connection to the server: it reconnects after a loss, and then requests everything again.

import { addressed } from "./addressed";
import { timeText } from "../draw/text";
import { decode } from "./frames";
import { saveFile } from "./save";
import type { Answer, Fits, Folder, ListedProblem, ToPage, ToServer } from "../protocol";
import { withoutNew } from "./waiting";
import { isRefused } from "./refused";
import { type Offer, useStudio } from "./store";
import { live } from "./live";
import { Streams } from "./streams";

export type Reply = { answer: Answer; folder: Folder | null; fits: Fits | null };

const AGAIN_MS = [200, 500, 1000, 2000];

class Socket {
  readonly streams = new Streams((message) => this.post(message));
  private socket: WebSocket | null = null;
  private lastRequest = 0;
  private waiting = new Map<number, (reply: Reply) => void>();
  private folders = new Map<number, Folder>();
  private fits = new Map<number, Fits>();
  private failed = 0;

  open(): void {
    // below the path of the page, which a proxy may have chosen
    const address = new URL(`ws${location.search}`, document.baseURI);
    address.protocol = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.failed = 0;
      this.socket = socket;
      useStudio.getState().connect("open");
      this.streams.renew(false);
    };
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) {
        this.streams.take(decode(data));
      } else {
        this.take(JSON.parse(data as string) as ToPage);
      }
    };
    socket.onclose = () => {
      this.socket = null;
      if (useStudio.getState().connection !== "refused") useStudio.getState().connect("lost");
      for (const [request, reply] of this.waiting) {
        reply(unanswered(request, "The connection to the studio was lost."));
      }
      this.waiting.clear();
      setTimeout(() => void this.again(), AGAIN_MS[Math.min(this.failed++, AGAIN_MS.length - 1)]);
    };
  }

  // A page that is refused tries on: another page of this browser may bring the new token.
  private async again(): Promise<void> {
    useStudio.getState().connect((await isRefused()) ? "refused" : "lost");
    this.open();
  }

  // Sends a message without waiting for an answer; dropped without a connection.
  post(message: ToServer): void {
    if (this.socket?.readyState === WebSocket.OPEN) {
      this.socket.send(JSON.stringify(addressed(message, useStudio.getState().session)));
    }
  }

  // Ask, and wait for the answer.
  async ask(message: ToServer): Promise<Reply> {
    const request = ++this.lastRequest;
    if (this.socket?.readyState !== WebSocket.OPEN) {
      return unanswered(request, "The page is not connected to the studio.");
    }
    return new Promise((resolve) => {
      this.waiting.set(request, resolve);
      this.post({ ...message, request } as ToServer);
    });
  }

  private take(message: ToPage): void {
    const store = useStudio.getState();
    switch (message.type) {
      case "answer":
        this.waiting.get(message.request)?.({
          answer: message,
          folder: this.folders.get(message.request) ?? null,
          fits: this.fits.get(message.request) ?? null,
        });
        this.waiting.delete(message.request);
        this.folders.delete(message.request);
        this.fits.delete(message.request);
        break;
      case "folder":
        this.folders.set(message.request, message);
        break;
      case "fitting":
        this.fits.set(message.request, message);
        break;
      case "scene":
      case "robot_link":
      case "solids":
      case "bodies":
        live.take(message, store.session);
        break;
      case "announced":
        this.streams.announce(message);
        break;
      case "lost":
        this.streams.lose(message);
        break;
      case "clock":
        store.take(message);
        this.post({ type: "drawn", frame: message.frame });
        break;
      case "checked": {
        const show = (later: ToPage) => useStudio.getState().session === store.session && store.take(later);
        store.take(withoutNew(message, store.document?.problems ?? [], show));
        break;
      }
      case "opened":
        store.take(message);
        if (message.session !== store.session) {
          this.streams.renew(true);
        }
        break;
      default:
        store.take(message);
    }
  }
}

function unanswered(request: number, what: string): Reply {
  return { answer: { type: "answer", request, problems: [{ what }] }, folder: null, fits: null };
}

export const socket = new Socket();

// Ask; the first problem is shown where it was asked.
export async function refusalOf(message: ToServer): Promise<ListedProblem | null> {
  return (await socket.ask(message)).answer.problems?.[0] ?? null;
}

// Ask; problems become a notice.
export async function request(message: ToServer): Promise<Answer> {
  const { answer } = await socket.ask(message);
  const { problems = [], fault } = answer;
  if (fault === true) {
    tellFault(message, problems);
  } else if (problems.length > 0) {
    useStudio.getState().notify(problems);
  }
  return answer;
}

// Of these a person wants to know what became of the run.
const OF_THE_RUN: readonly ToServer["type"][] = [
  "play",
  "step",
  "reset",
  "return_to",
  "run_from",
  "run_record_from",
  "repeat_trial",
  "leave_trial",
];

// deodar itself failed: what was asked for has no effect.
function tellFault({ type }: ToServer, problems: readonly ListedProblem[]): void {
  const { clock, document, notify } = useStudio.getState();
  const words = type.charAt(0).toUpperCase() + type.slice(1).replaceAll("_", " ");
  const asked = words.replace(/^Run (record )?from$/, "Run from here");
  const stands =
    clock === null || document === null || !OF_THE_RUN.includes(type)
      ? ""
      : ` The run is as it was at ${timeText(clock.time, document.time_unit)}.`;
  const copy: Offer = { label: "Copy the report", run: copyReport };
  const details: Offer = { label: "Details", run: () => notify(problems, "error", copy) };
  notify({ what: `${asked} failed.${stands}` }, "error", copy, details);
}

// The text that `deodar doctor --report` writes; a page that may not write to the clipboard saves it.
async function copyReport(): Promise<void> {
  const { text = "" } = await request({ type: "fault_report" });
  if (text === "") {
    return;
  }
  try {
    await navigator.clipboard.writeText(text);
    useStudio.getState().notify({ what: "The report is in the clipboard." }, "info");
  } catch {
    saveFile(new Blob([text], { type: "text/plain" }), "fault-report", "txt");
  }
}
