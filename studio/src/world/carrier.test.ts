import { expect, it } from "vitest";

import type { Answer, ToServer } from "../protocol";
import { Carrier } from "./carrier";

function carried() {
  const asked: { message: ToServer; answer: (problems?: Answer["problems"]) => Promise<void> }[] = [];
  const carrier = new Carrier(
    (message) =>
      new Promise((resolve) => {
        const answer = async (problems: Answer["problems"] = []) => {
          resolve({ type: "answer", request: 1, problems });
          await new Promise((later) => setTimeout(later));
        };
        asked.push({ message, answer });
      }),
    () => undefined,
  );
  return { asked, carrier };
}

it("one position is requested at a time, then the newest", async () => {
  const { asked, carrier } = carried();
  for (const x of [1, 2, 3]) carrier.carry("crate", { x, y: 0 });
  expect(asked.map(({ message }) => message)).toEqual([{ type: "move_object", name: "crate", x: 1, y: 0 }]);
  await asked[0]?.answer();
  expect(asked[1]?.message).toEqual({ type: "move_object", name: "crate", x: 3, y: 0 });
  await asked[1]?.answer();
  expect(asked.length).toBe(2);
});

it("the object is held until the last position is answered", async () => {
  const { asked, carrier } = carried();
  carrier.carry("crate", { x: 1, y: 0 });
  carrier.drop();
  expect(carrier.held?.name).toBe("crate");
  await asked[0]?.answer();
  expect(carrier.held).toBeNull();
});

it("the reason of a refused position is reported until a position is accepted", async () => {
  const { asked, carrier } = carried();
  carrier.carry("crate", { x: 1, y: 0 });
  await asked[0]?.answer([{ what: "lies inside 'wall'", where: "crate" }]);
  expect(carrier.refused).toBe("crate: lies inside 'wall'");
  carrier.carry("crate", { x: 2, y: 0 });
  await asked[1]?.answer();
  expect(carrier.refused).toBe("");
});
