import { expect, it } from "vitest";
import { History } from "../../server/history";
import { trajectory } from "./trajectory";

function history(times: number[], values: number[]): History {
  const made = new History();
  made.times = times;
  made.values = values;
  return made;
}

it("two time courses are paired at the times of both", () => {
  const one = history([0, 1, 2, 3], [10, 11, 12, 13]);
  const other = history([1, 3], [-1, -3]);
  expect(trajectory(one, other, [0, 9])).toEqual({ times: [1, 3], across: [11, 13], up: [-1, -3] });
  expect(trajectory(one, one, [1, 2]).times).toEqual([1, 2]);
});

it("the rate of a relaxation falls in a line to 0 at the fixed point", () => {
  // du/dt = -(u - 3) / 10
  const times = Array.from({ length: 400 }, (_, i) => i / 4);
  const { across, up } = trajectory(
    history(
      times,
      times.map((t) => 3 - 8 * Math.exp(-t / 10)),
    ),
    null,
    [0, 99],
  );
  expect(across).toHaveLength(396);
  across.forEach((u, i) => expect(up[i]).toBeCloseTo(-(u - 3) / 10, 4));
});
