"""How fast a run is to go, and how fast it goes."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deodar.runtime.session import Session

EXCHANGE = 0.01
"""Wall time of the steps between two exchanges, in seconds; with what else is done there, changes act within 20 ms."""

MEASURED = 0.5
"""Wall time over which the achieved speed is averaged, in seconds."""

SECONDS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "abstract": 1e-3}


def unit_seconds(time_unit: str) -> float:
    """Seconds in one unit of document time; abstract time counts as milliseconds."""
    if time_unit in SECONDS:
        return SECONDS[time_unit]
    _, _, number, unit = time_unit.split()  # "1 = 64 ms"
    return float(number) * SECONDS[unit]


class Pace:
    """Steps that are due.

    Attributes:
        speed: document time over wall time that is asked for; None: as fast as possible.
        factor: the same as it is achieved.
        steps: steps in one second of wall time, as achieved.
    """

    def __init__(self) -> None:
        self.speed: float | None = 1.0
        self.factor = 0.0
        self.steps = 0.0
        self._cost = 0.0
        self._owed = 0.0
        self._last = 0.0
        self._since = (0.0, 0.0, 0)
        self.restart()

    def go(self, speed: float | None) -> None:
        """Another speed from now on."""
        self.speed = speed
        self.restart()

    def restart(self) -> None:
        """Count from now: nothing is owed for the time in which it stood still."""
        self._last = time.perf_counter()
        self._owed = 0.0
        self._since = (self._last, 0.0, 0)
        self.factor = self.steps = 0.0

    def most(self) -> int:
        """Steps that fit between two exchanges."""
        return max(1, int(EXCHANGE / self._cost)) if self._cost else 1

    def due(self, session: Session) -> int:
        """Steps to take now. A machine that is too slow does not pile up what it owes."""
        most = self.most()
        if self.speed is None:
            return most
        now = time.perf_counter()
        self._owed += (now - self._last) * self._rate(session)
        self._last = now
        n = min(int(self._owed), most)
        self._owed = min(self._owed - n, float(most))
        return n

    def rest(self, session: Session) -> float:
        """Wall time until the next step is due."""
        return min(0.02, max(0.0005, (1.0 - self._owed) / self._rate(session)))

    def took(self, session: Session, n: int, seconds: float) -> None:
        """Learn from steps that were taken."""
        each = seconds / n
        self._cost = each if not self._cost else 0.7 * self._cost + 0.3 * each
        began, time_passed, steps = self._since
        time_passed, steps = time_passed + n * session.dt, steps + n
        now = time.perf_counter()
        if now - began >= MEASURED:
            self.factor = time_passed * unit_seconds(session.document.time_unit) / (now - began)
            self.steps = steps / (now - began)
            began, time_passed, steps = now, 0.0, 0
        self._since = (began, time_passed, steps)

    def _rate(self, session: Session) -> float:
        """Steps that are asked for in a second of wall time."""
        return (self.speed or 1.0) / (unit_seconds(session.document.time_unit) * session.dt)
