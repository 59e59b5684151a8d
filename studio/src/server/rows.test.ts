import { expect, it } from "vitest";
import { Rows } from "./rows";

const frame = (time: number, ...values: number[]) => ({
  stream: 1,
  frame: 1,
  time,
  values: Float32Array.from(values),
});

it("rows are kept in order of time, each once", () => {
  const rows = new Rows();
  rows.add(frame(10, 0, 1, 2, 5, 3, 4), 2);
  rows.add(frame(15, 0, 3, 4, 5, 5, 6), 2);
  expect(rows.times).toEqual([10, 15, 20]);
  expect([...(rows.at(17)?.values ?? [])]).toEqual([3, 4]);
  expect(rows.at(17)?.time).toBe(15);
  expect(rows.at(9)).toBeNull();
});

it("an earlier time or another number of values removes the rows before", () => {
  const rows = new Rows();
  rows.add(frame(10, 0, 1, 2), 2);
  rows.add(frame(0, 0, 3, 4), 2);
  expect(rows.times).toEqual([0]);
  rows.add(frame(1, 0, 3, 4, 5), 3);
  expect([rows.times, rows.width]).toEqual([[1], 3]);
});

it("rows are spread over a range of time, with gaps where there are none", () => {
  const rows = new Rows();
  rows.add(frame(10, 0, 1, 10, 2), 1);
  // columns end at 5, 10, 15, 20, 25, 30
  expect([...rows.spread([0, 30], 6)]).toEqual([Number.NaN, 1, 1, 2, 2, Number.NaN]);
});

it("the rows within a range of time are read one after another", () => {
  const rows = new Rows();
  rows.add(frame(10, 0, 1, 2, 5, 3, 4, 10, 5, 6), 2);
  expect(rows.within([12, 20])).toEqual({ times: [15, 20], values: [3, 4, 5, 6] });
});

it("only the newest rows are kept", () => {
  const rows = new Rows();
  for (let i = 0; i <= 2 * 16_384; i++) {
    rows.add(frame(i, 0, i), 1);
  }
  expect(rows.times.length).toBe(16_384);
  expect(rows.times[0]).toBe(16_385);
});
