import { expect, it } from "vitest";

import { linkText } from "./linkText";
import { LiveWorld } from "../server/live";

it("the link shows age, losses and the round trip", () => {
  const link = {
    type: "robot_link",
    robot: "epuck",
    age: 340,
    lost: 2,
    refused: 0,
    round_trip: 1.26,
  } as const;
  expect(linkText(link)).toBe("epuck: last message 0.3 s ago, 2 lost, round trip 1.3 ms");
  expect(linkText({ ...link, refused: 3, round_trip: 0 })).toBe(
    "epuck: last message 0.3 s ago, 2 lost, 3 refused",
  );
});

it("a world in the process of the server has no link", () => {
  const live = new LiveWorld();
  live.take({ type: "robot_link", robot: "epuck" });
  expect(live.link()?.robot).toBe("epuck");
  live.take({ type: "robot_link" });
  expect(live.link()).toBe(null);
});
