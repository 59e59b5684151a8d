import { expect, it } from "vitest";
import { csv, plane } from "./exportCsv";

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
