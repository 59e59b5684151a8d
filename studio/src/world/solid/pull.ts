// A push of a body with the mouse: a spring between the point that was gripped and the pointer.

import type { Point3 } from "../../plots/scenes/sceneView";
import type { Ask } from "../carrier";

// Of the spring, in N/m, and its largest force in N: guesses, with which an arm yields by some centimetres.
const STIFFNESS = 400;
const MOST = 100;

// The force of the spring from the gripped point towards the pointer.
export function force(grip: Point3, pointer: Point3): Point3 {
  const pull = pointer.map((value, d) => STIFFNESS * (value - (grip[d] as number)));
  const size = Math.hypot(...pull);
  return pull.map((value) => value * Math.min(1, MOST / Math.max(size, 1e-9))) as unknown as Point3;
}

// Sends the forces: one request at a time, the newest next, and no force at the end.
export class Puller {
  // Why the last push was refused; empty: it was not.
  refused = "";
  private next: { body: string; force: Point3 } | null = null;
  private asking = false;

  constructor(
    private ask: Ask,
    private changed: () => void,
  ) {}

  pull(body: string, force: Point3): void {
    this.next = { body, force };
    void this.go();
  }

  release(body: string): void {
    this.pull(body, [0, 0, 0]);
  }

  private async go(): Promise<void> {
    if (this.asking) {
      return;
    }
    this.asking = true;
    while (this.next !== null) {
      const { body, force } = this.next;
      this.next = null;
      const { problems } = await this.ask({ type: "push_body", body, force: [...force] });
      const reason = problems?.[0]?.what ?? "";
      if (reason !== this.refused) {
        this.refused = reason;
        this.changed();
      }
    }
    this.asking = false;
  }
}
