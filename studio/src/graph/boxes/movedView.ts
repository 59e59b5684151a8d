// The view of the canvas. While a hand moves it, the browser only shifts what it has: xyflow, whose store
// calls thousands of functions for each view, receives it some times a second and at the end.

import type { Viewport } from "@xyflow/react";

const SEND_MS = 100;

export class MovedView {
  // The same object throughout: xyflow reads it when it starts.
  readonly now: Viewport = { x: 0, y: 0, zoom: 1 };
  // How many views there were.
  changes = 0;
  private byHand = false;
  private timer: ReturnType<typeof setTimeout> | null = null;

  // `shift` moves the picture, `send` gives the view to xyflow.
  constructor(
    private shift: (view: Viewport) => void,
    private send: (view: Viewport) => void,
  ) {}

  readonly change = (view: Viewport): void => {
    Object.assign(this.now, view);
    this.changes += 1;
    if (this.byHand) {
      this.shift(view);
      this.timer ??= setTimeout(() => this.flush(), SEND_MS);
    } else {
      this.send(view);
    }
  };

  hold(byHand: boolean): void {
    this.byHand = byHand;
    this.flush();
  }

  // Runs a function with the next picture, unless the view changes before: where pictures are slow a timer
  // runs out between two steps of one movement.
  atRest(run: () => void): void {
    const { changes } = this;
    requestAnimationFrame(() => changes === this.changes && run());
  }

  // Send what is not sent yet.
  flush(): void {
    if (this.timer !== null) {
      clearTimeout(this.timer);
      this.timer = null;
      this.send({ ...this.now });
    }
  }
}
