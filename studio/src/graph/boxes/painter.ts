// When live boxes are drawn: in turn, as many for each picture of the browser as it can keep up with, and
// while the canvas is moved only those that were drawn almost a second ago.

type Draw = () => void;

const BUDGET_MS = 5;

// The cost of a box arises after the drawing, when the browser composes the page: the time between pictures
// measures it.
const FAST_MS = 24;
const SLOW_MS = 36;
const PAUSE_MS = 2000;
const LEAST = 2;
const MOST = 200;

// A box that would show the same drawing longer than this, if it missed one more picture of the browser, is
// drawn now, whatever it costs.
const LONGEST_MS = 900;

export class Painter {
  // `since`: when the owner was drawn last; before the first drawing, when it asked for it.
  private waiting = new Map<object, { draw: Draw; since: number }>();
  private drawn = new WeakMap<object, number>();
  private held = false;
  private asked = false;
  private share = 8;
  private last = 0;
  private interval = 0;

  // `after` runs when something was drawn.
  constructor(private after: () => void = () => undefined) {}

  // Draw when there is time; a later request of the same owner replaces the former.
  wish(owner: object, draw: Draw): void {
    const since = this.waiting.get(owner)?.since ?? this.drawn.get(owner) ?? performance.now();
    this.waiting.set(owner, { draw, since });
    this.ask();
  }

  forget(owner: object): void {
    this.waiting.delete(owner);
    this.drawn.delete(owner);
  }

  // While the canvas is moved boxes are drawn as rarely as possible; afterwards the newest values are.
  hold(held: boolean): void {
    this.held = held;
    this.ask();
  }

  private ask(): void {
    if (!this.asked && this.waiting.size > 0) {
      this.asked = true;
      requestAnimationFrame((now) => this.draw(now));
    }
  }

  private draw(now: number): void {
    this.asked = false;
    this.adapt(now - this.last);
    this.last = now;
    const begun = performance.now();
    const due = begun - LONGEST_MS + 1.5 * this.interval;
    if (!this.held) {
      this.drawSome(begun, due);
    } else if ([...this.waiting.values()].some(({ since }) => since <= due)) {
      // To show one box the whole layer is painted, so that all that wait are drawn with it.
      this.drawSome(begun, Infinity);
    } else {
      this.ask();
      return;
    }
    this.after();
    this.ask();
  }

  // Draw those that were drawn before `due`, and others while there is time.
  private drawSome(begun: number, due: number): void {
    let left = this.share;
    // A Map keeps the order in which owners came: who waited longest is drawn first.
    for (const [owner, { draw, since }] of this.waiting) {
      if (since > due && (left <= 0 || performance.now() > begun + BUDGET_MS)) {
        continue;
      }
      this.waiting.delete(owner);
      draw();
      this.drawn.set(owner, begun);
      left -= 1;
    }
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
