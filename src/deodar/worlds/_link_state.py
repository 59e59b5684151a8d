"""How well the link with a robot in another process works."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class LinkState:
    """Measurements of a link.

    Attributes:
        robot: name of the robot.
        age: time since the last message of the robot, ms.
        received: periods of the robot that arrived; messages, where its sensors come one by one.
        lost: periods that did not arrive.
        refused: messages that were not read: short, foreign, not finite, or with a number that goes back; and
            messages for the robot that it refused.
        round_trip: time from the last command that the robot answered to its answer, ms; 0: none yet.
        by_sensor: messages of each sensor, where they come one by one.
    """

    robot: str
    age: float
    received: int
    lost: int
    refused: int
    round_trip: float
    by_sensor: Mapping[str, int] = field(default_factory=dict[str, int])
