"""How well the link with a robot in another process works."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LinkState:
    """Measurements of a link.

    Attributes:
        robot: name of the robot.
        age: time since the last message of the robot, ms.
        received: periods of the robot that arrived.
        lost: periods that did not arrive.
        refused: messages that were not read: short, foreign, not finite, or with a number that goes back.
        round_trip: time from the last command that the robot answered to its answer, ms; 0: none yet.
    """

    robot: str
    age: float
    received: int
    lost: int
    refused: int
    round_trip: float
