"""How well the link with a robot works."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LinkState:
    """Measurements of a link.

    Attributes:
        age: time since the last message of the robot, ms.
        received: periods of the robot that arrived.
        lost: periods that did not arrive.
        refused: messages that were not read: short, foreign, not finite, or with a number that goes back.
        round_trip: time from the last command that the robot answered to its answer, ms; 0: none yet.
    """

    age: float
    received: int
    lost: int
    refused: int
    round_trip: float
