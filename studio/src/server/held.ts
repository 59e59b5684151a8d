// Something in a hand, such as a slider, an object of the world or an injected input: at most one message is
// on its way to the server, and the newest value is the next one.

// Numbers of gestures begin anywhere, so that a page that is reloaded does not continue a gesture of the
// one before.
let last = Math.floor(Math.random() * 2 ** 30);

export const newGesture = (): number => ++last;

// Keys that follow within this time belong to one gesture.
const IDLE_MS = 500;

export class Held<T> {
  private next: { value: T; gesture: number } | null = null;
  private gesture = 0;
  private flying = false;
  private down = false;
  private idle: ReturnType<typeof setTimeout> | undefined;

  // Changes with the same number of a gesture are one step of undo. `show` gets the value in the hand, and
  // null when it was let go and everything is answered.
  constructor(
    private readonly send: (value: T, gesture: number) => Promise<unknown>,
    private readonly show: (value: T | null) => void = () => {},
  ) {}

  get isDown(): boolean {
    return this.down;
  }

  // The pointer moved: the gesture lasts until `release`.
  move(value: T): void {
    clearTimeout(this.idle);
    this.gesture ||= newGesture();
    this.down = true;
    this.next = { value, gesture: this.gesture };
    this.show(value);
    void this.fly();
  }

  // A key was pressed: the gesture lasts until no key was pressed for a while.
  nudge(value: T): void {
    this.move(value);
    this.idle = setTimeout(() => this.release(), IDLE_MS);
  }

  release(): void {
    clearTimeout(this.idle);
    this.gesture = 0;
    this.down = false;
    this.settle();
  }

  private async fly(): Promise<void> {
    if (this.flying) {
      return;
    }
    this.flying = true;
    try {
      for (let now = this.next; now !== null; now = this.next) {
        this.next = null;
        await this.send(now.value, now.gesture);
      }
    } finally {
      this.flying = false;
      this.settle();
    }
  }

  private settle(): void {
    if (!this.flying && !this.down) {
      this.show(null);
    }
  }
}
