/** How much other processes slow this machine down at the moment. */

const SPIN_MS = 150;

/**
 * The wall time of a computation over its processor time: 1 on a machine that is free. Limits in wall time
 * are multiplied by it, so that tests beside others do not fail, and fail on a free machine where they
 * should.
 */
export function crowding(): number {
  const [from, before] = [performance.now(), process.cpuUsage()];
  let spent = 0;
  while (spent < SPIN_MS) {
    const { user, system } = process.cpuUsage(before);
    spent = (user + system) / 1000;
  }
  return Math.max(1, (performance.now() - from) / spent);
}
