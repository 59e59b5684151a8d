"""The pace of a run: the number of steps that are due by the wall clock.

After Lomp, Richter, Zibner and Schoener (2016), section 3.2: a step is taken when the wall clock reaches its
time. Times are counted from one start and not from step to step, so that delays do not add up.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Protocol

from deodar.compiler.executable import Executable
from deodar.errors import DeodarError, TimeError
from deodar.model.document import Document
from deodar.model.unit import unit_seconds
from deodar.parameters import real, show
from deodar.session.meter import Meter
from deodar.session.run import require_step, whole
from deodar.worlds._base import World

EXCHANGE = 0.01
"""Wall time of the steps between two exchanges, in seconds; a change takes effect within 20 ms."""

MEASURED = 0.5
"""Wall time over which the achieved speed is averaged, and a lengthened step kept at least, in seconds."""

MOST_LAG = 0.25
"""Largest lag that a run catches up, in seconds; the rest is dropped.

A guess: longer than a short delay of the machine, after which the run should return to the wall clock, and
shorter than a suspension (a laptop that slept), after which a burst of old steps is useless.
"""

RESERVE = 1.1
"""Ratio of a lengthened step's wall time to its computing time: a guess above 1, so that the lag shrinks."""


class Paced(Protocol):
    """The attributes of a session that a pace uses."""

    @property
    def world(self) -> World | None: ...

    @property
    def document(self) -> Document: ...

    @property
    def program(self) -> Executable: ...

    @property
    def time(self) -> float: ...

    @property
    def dt(self) -> float: ...

    @dt.setter
    def dt(self, value: float) -> None: ...

    @property
    def next_dt(self) -> float: ...

    def step(self, n: int = 1) -> None: ...


class Pace:
    """Computes the steps that are due by the wall clock.

    If the machine is too slow, the run falls behind, and the meter shows it; the steps are unchanged, so that
    the result is that of any other run. With `longest` the step grows instead, in whole multiples of the
    planned one, as in cedar; the session's journal has every such change.

    Args:
        clock: function that returns the wall clock, in seconds.
        sleep: function that waits for a number of seconds.

    Attributes:
        clock, sleep: these functions.
        speed: requested ratio of document time to wall time; None: as fast as possible.
        longest: the longest step that may be taken to keep up, in document time; None: the step is constant.
        factor: achieved ratio of document time to wall time, over the last half second.
        steps: achieved number of steps per second of wall time.
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        self.clock, self.sleep = clock, sleep
        self.speed: float | None = 1.0
        self.longest: float | None = None
        self.factor = 0.0
        self.steps = 0.0
        self._cost = 0.0
        self._planned = self._set_step = 0.0
        self._of: Paced | None = None
        self._program: Executable | None = None
        self.restart()

    def go(self, speed: float | None) -> None:
        """Set the speed, and count from now."""
        self.speed = speed
        self.restart()

    def restart(self) -> None:
        """Count from now: no steps are due for the time of a pause."""
        self._began = self.clock()
        self._unit = 1e-3
        self._passed = self._given_up = 0.0
        self._since = (self._began, 0.0, 0)
        self._late_since: float | None = None
        self._changed = -math.inf
        self._lag = self._worst = self._longest = self._step = 0.0
        self._taken = self._overruns = self._lengthened = 0
        self.factor = self.steps = 0.0

    def most(self, session: Paced) -> int:
        """Return the number of steps that fit between two exchanges.

        It is 1 after a change of the program: a step of an empty document takes about a nanosecond, and as
        many steps of the next program would take hours.
        """
        self._follow(session)
        return max(1, int(EXCHANGE / self._cost)) if self._cost else 1

    def due(self, session: Paced) -> int:
        """Return the number of steps to take now."""
        if self.speed is None:
            return self.most(session)
        owed = self._owed(session)
        most = max(MOST_LAG, 2 * self._wall(session))
        if owed > most:  # dropped, as for a pause of this length
            self._given_up += owed - most
            owed = most
        self._late(owed - self._wall(session), session)
        return min(int(owed / self._wall(session) + 1e-6), self.most(session))

    def rest(self, session: Paced) -> float:
        """Return the wall time until the next step is due, in seconds."""
        return min(0.02, max(0.0, self._wall(session) - self._owed(session)))

    def took(self, session: Paced, n: int, passed: float, seconds: float) -> None:
        """Record that `n` steps were taken, `passed` in document time, `seconds` in wall time."""
        self._follow(session)
        step_cost = seconds / n
        self._cost = step_cost if not self._cost else 0.7 * self._cost + 0.3 * step_cost
        self._passed += passed
        self._taken += n
        step = passed / n
        self._step = max(self._step, step)
        self._lengthened += n if self._planned and step > self._planned * 1.001 else 0
        if self.speed is not None:
            self._late(self._owed(session), session)
        began, time_passed, steps = self._since
        time_passed, steps = time_passed + passed, steps + n
        moment = self.clock()
        if moment - began >= MEASURED:
            self.factor = time_passed * self._unit / (moment - began)
            self.steps = steps / (moment - began)
            began, time_passed, steps = moment, 0.0, 0
        self._since = (began, time_passed, steps)

    def lengthen(self, session: Paced) -> None:
        """Lengthen the step if there is not enough time for the planned one, else shorten it again.

        A step grows at once and shrinks after half a second at the earliest. The period of the world is a
        whole number of steps, and the step is within the limit of every time constant.
        """
        # the step was set from outside: it is the planned one from now on
        if session is not self._of or session.next_dt != self._set_step:
            self._of, self._planned, self._set_step = session, session.next_dt, session.next_dt
        if self.longest is None or self.speed is None or not self._cost:
            multiple = 1
        else:
            wall = self._planned * self._unit / self.speed
            needed = max(RESERVE * self._cost / wall, self._lag / (self.most(session) * wall))
            multiple = max(1, math.ceil(needed - 1e-6))
        factor = round(self._set_step / self._planned)
        if multiple < factor and self.clock() - self._changed < MEASURED:
            return
        self._take(session, self._allowed(session, multiple))

    def shorten(self, session: Paced) -> None:
        """Return to the planned step."""
        if session is self._of and session.next_dt == self._set_step:
            self._take(session, self._planned)

    def meter(self, session: Paced) -> Meter:
        """Return the measurements since the start."""
        unit, wall = unit_seconds(session.document.time_unit), self.clock() - self._began
        late = 0.0 if self._late_since is None else self.clock() - self._late_since
        return Meter(
            speed=self.speed,
            factor=self._passed * unit / wall if wall > 0 else 0.0,
            time=self._passed,
            wall=wall,
            steps=self._taken,
            lag=1e3 * self._lag,
            worst=1e3 * self._worst,
            lost=1e3 * self._given_up,
            overruns=self._overruns,
            longest=1e3 * max(self._longest, late),
            lengthened=self._lengthened,
            step=self._step,
        )

    # ------------------------------------------------------------------------------------------------- inside

    def _follow(self, session: Paced) -> None:
        """Forget the cost of a step if the program has changed."""
        if session.program is not self._program:
            self._program, self._cost = session.program, 0.0

    def _owed(self, session: Paced) -> float:
        """Return the wall time for which no step was taken yet, in seconds."""
        self._unit = unit_seconds(session.document.time_unit)
        return self.clock() - self._began - self._given_up - self._passed * self._unit / (self.speed or 1.0)

    def _wall(self, session: Paced) -> float:
        """Return the wall time of one step at the requested speed, in seconds."""
        return unit_seconds(session.document.time_unit) * session.dt / (self.speed or 1.0)

    def _late(self, lag: float, session: Paced) -> None:
        """Record a lag: the delay of the oldest step that is due, or of the newest that was taken."""
        self._lag = max(0.0, lag)
        self._worst = max(self._worst, self._lag)
        moment = self.clock()
        if self._lag > max(EXCHANGE, self._wall(session)):
            if self._late_since is None:
                self._late_since = moment - self._lag  # the time at which the step was due
                self._overruns += 1
        elif self._late_since is not None:
            self._longest = max(self._longest, moment - self._late_since)
            self._late_since = None

    def _allowed(self, session: Paced, multiple: int) -> float:
        """Return the longest step that the bound, the time constants and the world allow.

        It is a whole multiple of the planned step, at most `multiple` times as long.
        """
        bound = self._planned if self.longest is None else self.longest
        for k in range(min(multiple, int(bound / self._planned + 1e-9)), 1, -1):
            step = k * self._planned
            try:
                require_step(session.document, step)
                if session.world is not None and session.world.period is not None:
                    whole(1e-3 * session.world.period / self._unit, step, "the world's period")
            except DeodarError:
                continue
            return step
        return self._planned

    def _take(self, session: Paced, step: float) -> None:
        if step != self._set_step:
            self._set_step, self._changed = step, self.clock()
            session.dt = step


def require_speed(speed: object) -> float | None:
    """Return a speed above 0, or None (as fast as possible); raise TimeError for any other value."""
    number = None if speed is None else real(speed)
    if speed is not None and (number is None or not 0 < number < math.inf):
        raise TimeError(
            f"a speed is a number above 0, or None for as fast as possible, not {show(speed)}",
            fix="1.0 is real time, 0.1 slow motion",
        )
    return number


def require_longest(session: Paced, longest: object) -> float | None:
    """Return the limit of a step that may grow.

    Raises:
        TimeError: the limit is shorter than the present step, or longer than the time constants allow.
    """
    if longest is None:
        return None
    number = real(longest)
    if number is None or number < session.next_dt:
        raise TimeError(
            f"the longest step is {show(longest)}; expected a number, not below the planned step of"
            f" {session.next_dt:g}",
            fix="Leave it out to keep the step",
        )
    require_step(session.document, number)
    return number
