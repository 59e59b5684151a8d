"""The meter of a run that is paced to the wall clock."""

from __future__ import annotations

import dataclasses as dc

from deodar.summary import Summarised, Summary


@dc.dataclass(frozen=True, repr=False)
class Meter(Summarised):
    """Lag and overruns of a run that is paced to the wall clock, since it began.

    Wall times are in milliseconds unless said otherwise. After Lomp, Richter, Zibner and Schoener (2016),
    section 3.2, whose meter counts steps that took too long.

    Attributes:
        speed: requested ratio of document time to wall time; None: as fast as possible, without any lag.
        factor: achieved ratio of document time to wall time (real-time factor).
        time: document time that passed, in the document's unit.
        wall: wall time that passed, in seconds.
        steps: number of Euler steps taken.
        lag: present delay behind the wall clock, which the run will catch up.
        worst: the largest lag since the start.
        lost: wall time that was dropped, because the lag was too large to be caught up.
        overruns: number of times the run fell behind by more than the time between two exchanges (or by more
            than a step, if that is longer).
        longest: duration of the longest overrun, from the time that was missed until it was caught up.
        lengthened: number of steps that were longer than planned.
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
        """Total delay of document time behind the wall clock, in milliseconds: `lag` plus `lost`."""
        return self.lag + self.lost

    def data(self) -> dict[str, float | int | None]:
        """Return the meter as plain numbers, for JSON."""
        return dc.asdict(self) | {"drift": self.drift}

    def __str__(self) -> str:
        speed = "as fast as possible" if self.speed is None else f"asked for {self.speed:g}"
        parts = [f"{self.factor:.4g} times real time ({speed}), {self.steps} steps in {self.wall:.3f} s"]
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

    def _summary(self) -> Summary:
        speed = "as fast as possible" if self.speed is None else f"asked for {self.speed:g}"
        rows: list[tuple[str, object]] = [("steps", self.steps), ("wall time", f"{self.wall:.3f} s")]
        if self.speed is not None:
            rows.append(("behind at the end", f"{self.lag:.2f} ms"))
            rows.append(("behind at most", f"{self.worst:.2f} ms"))
            rows.append(("overruns", self.overruns))
        return Summary(f"{self.factor:.4g} times real time ({speed})", rows)
