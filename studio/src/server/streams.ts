// Live arrays on their way from the socket to canvases, past React: each subscriber is called at most once
// for each picture the browser draws, with the newest frame. Equal requests share one stream.

import type { Frame } from "./frames";
import type { Announced, Lost, Watch, WatchKernel, WatchRows, WatchTrace, WatchWeights } from "../protocol";
import { History } from "./history";
import { Rows } from "./rows";

type Watching = Watch | WatchTrace | WatchRows | WatchKernel | WatchWeights;

export type Wish =
  | Omit<Watch, "stream" | "request">
  | Omit<WatchTrace, "stream" | "request">
  | Omit<WatchRows, "stream" | "request">
  | Omit<WatchKernel, "stream" | "request">
  | Omit<WatchWeights, "stream" | "request">;

export type Live = {
  // The format of the stream; null until the server has sent it.
  form: Announced | null;
  // The newest frame; null until one came. Of a time course use `history`, of rows `rows`.
  frame: Frame | null;
  // The time course so far, for requests of type "trace".
  history: History;
  // The rows so far, for requests of type "rows".
  rows: Rows;
  lost: Lost | null;
};

type Subscriber = (live: Live) => void;

type Stream = {
  number: number;
  wish: Wish;
  live: Live;
  subscribers: Set<Subscriber>;
  waiting: Set<Subscriber>;
};

type SendWish = (message: Watching | { type: "unwatch"; stream: number }) => void;

export class Streams {
  private byKey = new Map<string, Stream>();
  private byNumber = new Map<number, Stream>();
  private last = 0;
  private drawing = false;

  constructor(private send: SendWish) {}

  // Ask for live data; the function returned ends it. The callback also runs when the form changes or the
  // stream is lost.
  subscribe(wish: Wish, callback: Subscriber): () => void {
    const key = JSON.stringify(wish);
    let stream = this.byKey.get(key);
    if (stream === undefined) {
      const live: Live = {
        form: null,
        frame: null,
        history: new History(),
        rows: new Rows(),
        lost: null,
      };
      stream = { number: ++this.last, wish, live, subscribers: new Set(), waiting: new Set() };
      this.byKey.set(key, stream);
      this.byNumber.set(stream.number, stream);
      this.ask(stream);
    } else if (stream.live.frame !== null || stream.live.lost !== null) {
      this.wake(stream, callback);
    }
    const found = stream;
    found.subscribers.add(callback);
    return () => {
      found.subscribers.delete(callback);
      found.waiting.delete(callback);
      if (found.subscribers.size === 0 && this.byKey.get(key) === found) {
        this.byKey.delete(key);
        this.byNumber.delete(found.number);
        this.send({ type: "unwatch", stream: found.number });
      }
    };
  }

  // After a new connection, or a new document: ask again for everything.
  renew(forget: boolean): void {
    for (const stream of this.byNumber.values()) {
      if (forget) {
        stream.live.frame = null;
        stream.live.history.clear();
        stream.live.rows.clear();
      }
      stream.live.lost = null;
      this.ask(stream);
    }
  }

  announce(form: Announced): void {
    this.change(form.stream, (live) => {
      live.form = form;
      live.frame = null;
      live.lost = null;
    });
  }

  lose(lost: Lost): void {
    this.change(lost.stream, (live) => {
      live.lost = lost;
      live.frame = null;
    });
  }

  take(frame: Frame): void {
    const stream = this.byNumber.get(frame.stream);
    if (stream?.live.form == null) {
      return;
    }
    if (stream.wish.type === "trace") {
      stream.live.history.add(frame);
    } else if (stream.wish.type === "rows") {
      stream.live.rows.add(frame, size(stream.live.form.shape) - 1);
    } else if (frame.values.length !== size(stream.live.form.shape)) {
      return; // on its way while the shape changed
    }
    stream.live.frame = frame;
    for (const subscriber of stream.subscribers) {
      this.wake(stream, subscriber);
    }
  }

  private ask(stream: Stream): void {
    this.send({ ...stream.wish, stream: stream.number });
  }

  private change(number: number, how: (live: Live) => void): void {
    const stream = this.byNumber.get(number);
    if (stream !== undefined) {
      how(stream.live);
      for (const subscriber of stream.subscribers) {
        this.wake(stream, subscriber);
      }
    }
  }

  private wake(stream: Stream, subscriber: Subscriber): void {
    stream.waiting.add(subscriber);
    if (!this.drawing) {
      this.drawing = true;
      requestAnimationFrame(() => this.draw());
    }
  }

  private draw(): void {
    this.drawing = false;
    for (const stream of this.byNumber.values()) {
      const waiting = [...stream.waiting];
      stream.waiting.clear();
      for (const subscriber of waiting) {
        subscriber(stream.live);
      }
    }
  }
}

function size(shape: number[]): number {
  return shape.reduce((product, n) => product * n, 1);
}
