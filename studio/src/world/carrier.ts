// Carries an object to where the pointer is: one request at a time, the newest place next, so that a slow run
// is asked no more than it can do.

import type { Answer, ToServer } from "../protocol";
import type { PlanPoint } from "./planFrame";

export type Ask = (message: ToServer) => Promise<Answer>;

export class Carrier {
  // The dragged object and its target; null: none.
  held: { name: string; at: PlanPoint } | null = null;
  // Why the last place was refused; empty where it was not.
  refused = "";
  private asking = false;
  private due = false;
  private down = false;

  // `changed` is called when the state above changed.
  constructor(
    private ask: Ask,
    private changed: () => void,
  ) {}

  carry(name: string, at: PlanPoint): void {
    this.held = { name, at };
    this.down = false;
    this.due = true;
    this.changed();
    void this.go();
  }

  // Let go: the object stays at the last place that was not refused.
  drop(): void {
    this.down = true;
    this.settle();
  }

  // An earlier refusal is no longer shown.
  forgive(): void {
    this.refuse("");
  }

  // Show why something cannot be placed; empty: nothing was refused.
  refuse(reason: string): void {
    this.refused = reason;
    this.changed();
  }

  private async go(): Promise<void> {
    if (this.asking) {
      return;
    }
    this.asking = true;
    while (this.due && this.held !== null) {
      this.due = false;
      const { name, at } = this.held;
      const { problems } = await this.ask({ type: "move_object", name, x: at.x, y: at.y });
      const [problem] = problems ?? [];
      this.refused =
        problem === undefined
          ? ""
          : [problem.where, problem.what].filter((part) => part !== undefined && part !== "").join(": ");
      this.changed();
    }
    this.asking = false;
    this.settle();
  }

  private settle(): void {
    if (this.down && !this.asking) {
      this.held = null;
      this.down = false;
      this.changed();
    }
  }
}
