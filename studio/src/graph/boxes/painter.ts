// When live boxes are drawn: in turn, as many for each picture of the browser as it can keep up with, and not
// while the canvas is moved.

type Draw = () => void;

const BUDGET_MS = 5;

// The cost of a box arises after the drawing, when the browser composes the page: the time between pictures
// measures it.
const FAST_MS = 24;
const SLOW_MS = 36;
const PAUSE_MS = 2000;
const LEAST = 2;
const MOST = 200;

// A box that would wait longer than this if it missed one more picture of the browser is drawn now, whatever
// it costs.
const LONGEST_MS = 900;

export class Painter {
  private waiting = new Map<object, { draw: Draw; since: number }>();
  private held = false;
  private asked = false;
  private share = 8;
  private last = 0;
  private interval = 0;

  // `after` runs when something was drawn.
  constructor(private after: () => void = () => undefined) {}

  // Draw when there is time; a later request of the same owner replaces the former.
  wish(owner: object, draw: Draw): void {
    this.waiting.set(owner, { draw, since: this.waiting.get(owner)?.since ?? performance.now() });
    this.ask();
  }

  forget(owner: object): void {
    this.waiting.delete(owner);
  }

  // While the canvas is moved nothing is drawn; afterwards the newest values are.
  hold(held: boolean): void {
    this.held = held;
    this.ask();
  }

  private ask(): void {
    if (!this.asked && !this.held && this.waiting.size > 0) {
      this.asked = true;
      requestAnimationFrame((now) => this.draw(now));
    }
  }

  private draw(now: number): void {
    this.asked = false;
    if (this.held) {
      return;
    }
    this.adapt(now - this.last);
    this.last = now;
    const begun = performance.now();
    const due = begun - LONGEST_MS + 1.5 * this.interval;
    let left = this.share;
    // A Map keeps the order in which owners came: who waited longest is drawn first.
    for (const [owner, { draw, since }] of this.waiting) {
      if (since > due && (left <= 0 || performance.now() > begun + BUDGET_MS)) {
        break;
      }
      this.waiting.delete(owner);
      draw();
      left -= 1;
    }
    this.after();
    this.ask();
  }

  // A long pause is no measure: there was nothing to draw.
  private adapt(since: number): void {
    this.interval = since < PAUSE_MS ? since : 0;
    if (since < FAST_MS) {
      this.share = Math.min(MOST, this.share + 1);
    } else if (since > SLOW_MS && since < PAUSE_MS) {
      this.share = Math.max(LEAST, Math.floor(this.share * 0.7));
    }
  }
}
