import { expect, it } from "vitest";
import type { Axis } from "./axis";
import { arrayTable, csv, plane } from "./table";

it("a table has a header, and empty cells where values are missing", () => {
  const columns = [Float64Array.from([0, 0.5]), [1, null], Float32Array.from([0.1, Number.NaN])];
  expect(csv({ header: ["x (deg)", 'a "b", c', "u"], columns })).toBe(
    'x (deg),"a ""b"", c",u\n0,1,0.100000001\n0.5,,\n',
  );
});

it("a plane has one row for each value", () => {
  const columns = plane([1, 2], [10, 20, 30], [0, 1, 2, 3, 4, 5]);
  expect(csv({ header: ["x", "y", "u"], columns })).toBe(
    "x,y,u\n1,10,0\n1,20,1\n1,30,2\n2,10,3\n2,20,4\n2,30,5\n",
  );
});

const axis = (name: string, samples: number): Axis => ({
  name,
  lower: 0,
  upper: samples - 1,
  samples,
  periodic: false,
  unit: "cm",
});
const form = (shape: number[], axes: Axis[], channels = false) => ({ shape, axes, channels });

it("a table states that values are thinned, with the number of samples", () => {
  const whole = arrayTable(form([2], [axis("x", 2)]), Float32Array.from([5, 6]), "u");
  expect(whole?.header).toEqual(["x (cm)", "u"]);
  const thinned = arrayTable(form([2], [axis("x", 1000)]), Float32Array.from([5, 6]), "u");
  expect(thinned?.header).toEqual(["x (cm) [thinned: 2 values of 1000 samples]", "u"]);
  expect(arrayTable(form([], []), new Float32Array(), "u")).toBeNull();
});

it("a picture has a column for each channel", () => {
  const values = Float32Array.from([1, 2, 3, 4, 5, 6]);
  const table = arrayTable(form([1, 2, 3], [axis("x", 1), axis("y", 2)], true), values, "output");
  expect(table === null ? "" : csv(table)).toBe(
    "x (cm),y (cm),output red,output green,output blue\n0,0,1,2,3\n0,1,4,5,6\n",
  );
});
