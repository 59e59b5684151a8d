// A slider that is dragged: changes that are one step of undo, at most one on its way to the server, the
// newest wins.

// Numbers of gestures begin anywhere, so that a page that is reloaded does not continue a gesture of the
// one before.
let last = Math.floor(Math.random() * 2 ** 30);

export const newGesture = (): number => ++last;

type SendValue<T> = (value: T, gesture: number) => Promise<unknown>;
type Schedule = (draw: () => void) => void;

// Keys that follow within this time belong to one gesture.
const IDLE_MS = 500;

export class Gesture<T> {
  private number = 0;
  private next: { value: T; gesture: number } | null = null;
  private flying = false;
  private waiting = false;
  private held = false;
  private idle: ReturnType<typeof setTimeout> | undefined;

  // `settled` is called when everything was sent and answered, and no button is pressed.
  constructor(
    private send: SendValue<T>,
    private settled: () => void,
    private frame: Schedule = (draw) => void requestAnimationFrame(draw),
  ) {}

  // The pointer moved: the gesture lasts until `end`.
  move(value: T): void {
    this.held = true;
    this.take(value);
  }

  // A key was pressed: the gesture lasts until no key was pressed for a while.
  nudge(value: T): void {
    this.held = false;
    this.take(value);
    this.idle = setTimeout(() => this.end(), IDLE_MS);
  }

  end(): void {
    clearTimeout(this.idle);
    this.number = 0;
    this.held = false;
    this.settle();
  }

  private take(value: T): void {
    clearTimeout(this.idle);
    if (this.number === 0) {
      this.number = newGesture();
    }
    this.next = { value, gesture: this.number };
    this.wait();
  }

  private wait(): void {
    if (!this.waiting && !this.flying) {
      this.waiting = true;
      this.frame(() => void this.fly());
    }
  }

  private async fly(): Promise<void> {
    this.waiting = false;
    const going = this.next;
    if (going === null) {
      return;
    }
    this.next = null;
    this.flying = true;
    await this.send(going.value, going.gesture);
    this.flying = false;
    if (this.next !== null) {
      this.wait();
    }
    this.settle();
  }

  private settle(): void {
    if (!this.flying && this.next === null && !this.held) {
      this.settled();
    }
  }
}
