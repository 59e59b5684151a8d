// An input that a person adds to an element while a button is held: sent to the server at most once for each
// picture of the browser.

import type { PushInput, Release } from "../../protocol";

export type Spot = { center: number[] | null; sigma: number[] | null; amplitude: number };

export class Pusher {
  private held: string | null = null;
  private next: PushInput | null = null;
  private due = 0;

  constructor(private send: (message: PushInput | Release) => void) {}

  get pushing(): boolean {
    return this.held !== null;
  }

  // Begin, or continue at another place.
  push(element: string, { center, sigma, amplitude }: Spot): void {
    const first = this.held === null;
    this.held = element;
    this.next = { type: "push", element, amplitude, center, sigma };
    if (first) {
      this.tell();
    } else if (this.due === 0) {
      this.due = requestAnimationFrame(() => this.tell());
    }
  }

  release(): void {
    if (this.held === null) {
      return;
    }
    cancelAnimationFrame(this.due);
    this.due = 0;
    this.held = null;
    this.next = null;
    this.send({ type: "release" });
  }

  private tell(): void {
    this.due = 0;
    if (this.next !== null) {
      this.send(this.next);
      this.next = null;
    }
  }
}
