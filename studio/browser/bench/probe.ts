/**
 * A script that runs in the page before the page's own. It records when canvases are drawn, and what arrives
 * over the socket.
 */

/** A function of the page as a script for `open`. */
export function asScript(probe: () => void): string {
  return `(${probe.toString()})()`;
}

export interface Probe {
  /** For each canvas the time at which it was last cleared, in ms, and how often. */
  drawn: Map<HTMLCanvasElement, { at: number; times: number }>;
  /** Number of images drawn on canvases and of canvases cleared. */
  draws: number;
  /** Called with each binary message. */
  heard: (data: ArrayBuffer) => void;
  /** The requests of the page by number of stream. */
  watched: Map<number, { type: string; element: string; port: string; most?: number }>;
  /** The newest clock. */
  clock: { factor: number; steps: number; time: number; running: boolean } | null;
}

declare global {
  interface Window {
    probe: Probe;
  }
}

export function install(): void {
  const probe: Probe = {
    drawn: new Map(),
    draws: 0,
    heard: () => undefined,
    watched: new Map(),
    clock: null,
  };
  window.probe = probe;
  const note = (canvas: HTMLCanvasElement) => {
    const before = probe.drawn.get(canvas);
    probe.draws += 1;
    probe.drawn.set(canvas, { at: performance.now(), times: (before?.times ?? 0) + 1 });
  };
  const context = CanvasRenderingContext2D.prototype;
  const { clearRect, putImageData } = context;
  context.clearRect = function (...args) {
    note(this.canvas);
    clearRect.apply(this, args);
  };
  context.putImageData = function (...args: unknown[]) {
    note(this.canvas);
    putImageData.apply(this, args as Parameters<typeof putImageData>);
  };
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(...args: ConstructorParameters<typeof Plain>) {
      super(...args);
      this.addEventListener("message", ({ data }) => {
        if (data instanceof ArrayBuffer) probe.heard(data);
        else if (typeof data === "string" && data.includes('"clock"'))
          probe.clock = JSON.parse(data) as Probe["clock"];
      });
    }
    override send(data: string): void {
      const message = JSON.parse(data) as { type: string; stream: number; element: string; port: string };
      if (message.type === "watch" || message.type === "trace") probe.watched.set(message.stream, message);
      super.send(data);
    }
  };
}
