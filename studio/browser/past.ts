/** The past of a run, for tests. */
import type { TimelineView } from "../src/protocol";
import type { Observer } from "./observer";

export const timelineOf = (observer: Observer): TimelineView | null => observer.clock?.timeline ?? null;

/** Begin again, and take steps of 1 that are all published. */
export async function openPast(observer: Observer, steps: number): Promise<void> {
  await observer.ask({ type: "reset" });
  await observer.until(() => timelineOf(observer)?.last === 0);
  for (let tick = 1; tick <= steps; tick++) {
    await observer.ask({ type: "step", n: 1 });
    await observer.until(() => timelineOf(observer)?.last === tick);
  }
}
