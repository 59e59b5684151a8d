"""The meter of a run that is paced to the wall clock."""

from __future__ import annotations

import dataclasses as dc


@dc.dataclass(frozen=True)
class Meter:
    """Lag and overruns of a run that is paced to the wall clock, since it began.

    Wall times are in milliseconds unless said otherwise. After Lomp, Richter, Zibner and Schoener (2016),
    section 3.2, whose meter counts steps that took too long.

    Attributes:
        speed: document time over wall time that was asked for; None: as fast as possible, where nothing can
            be late.
        factor: the same as it was achieved (real-time factor).
        time: document time that passed, in the document's unit.
        wall: wall time that passed, in seconds.
        steps: Euler steps taken.
        lag: how far the run is behind the wall now, and will catch up.
        worst: the largest lag since it began.
        lost: wall time that was given up, because the lag had grown beyond what is caught up.
        overruns: how often the run fell behind by more than the time between two exchanges (or by a step, if
            that is longer).
        longest: the longest of them, from the moment that was missed until it was caught up.
        lengthened: steps that were longer than planned.
        step: the longest step taken, in the document's unit of time.
    """

    speed: float | None = 1.0
    factor: float = 0.0
    time: float = 0.0
    wall: float = 0.0
    steps: int = 0
    lag: float = 0.0
    worst: float = 0.0
    lost: float = 0.0
    overruns: int = 0
    longest: float = 0.0
    lengthened: int = 0
    step: float = 0.0

    @property
    def drift(self) -> float:
        """How far document time is behind the wall in all, in milliseconds: what will be caught up and what
        was given up.
        """
        return self.lag + self.lost

    def data(self) -> dict[str, float | int | None]:
        """The meter as plain numbers, for JSON."""
        return dc.asdict(self) | {"drift": self.drift}

    def __str__(self) -> str:
        asked = "as fast as possible" if self.speed is None else f"asked for {self.speed:g}"
        parts = [f"{self.factor:.4g} times real time ({asked}), {self.steps} steps in {self.wall:.3f} s"]
        if self.speed is not None:
            parts.append(f"behind by {self.lag:.2f} ms at the end, {self.worst:.2f} ms at most")
            parts.append(
                f"{self.overruns} overrun{'' if self.overruns == 1 else 's'}"
                + (f", the longest {self.longest:.0f} ms" if self.overruns else "")
            )
        if self.lost:
            parts.append(f"{self.lost:.0f} ms given up")
        if self.lengthened:
            parts.append(f"{self.lengthened} steps lengthened, up to {self.step:g}")
        return "; ".join(parts)
