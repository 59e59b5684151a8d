"""The clock of a run."""

from __future__ import annotations

import dataclasses as dc


@dc.dataclass(frozen=True)
class Clock:
    """Document time as a count of ticks: `time = t0 + (tick - tick0) * dt`, in float64 on the host."""

    tick: int
    t0: float
    tick0: int
    dt: float

    @property
    def time(self) -> float:
        """Document time of the tick."""
        return self.t0 + (self.tick - self.tick0) * self.dt

    @property
    def origin(self) -> dict[str, float]:
        """An earlier reference tick, less than 2^31 ticks ago, and its time.

        The reference is the same for 2^31 successive ticks.
        """
        passed = (self.tick - self.tick0) // 2**31 * 2**31
        return {"origin": (self.tick0 + passed) % 2**32, "start": self.t0 + passed * self.dt}

    def after(self, ticks: int) -> Clock:
        """Return the clock a number of ticks later."""
        return dc.replace(self, tick=self.tick + ticks)

    def at(self, dt: float) -> Clock:
        """Return the clock with another step from this tick on."""
        return Clock(self.tick, self.time, self.tick, dt)
