"""Run a session paced to the wall clock, for scripts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from deodar.session.interrupt import stoppable
from deodar.session.meter import Meter
from deodar.session.pace import Pace, Paced, require_longest, require_speed
from deodar.session.run import require_duration, whole


def run_live(
    session: Paced,
    duration: float,
    speed: float | None = 1.0,
    longest_step: float | None = None,
    between: Callable[[], object] | None = None,
    pace: Pace | None = None,
    sleep: Callable[[float], object] = time.sleep,
) -> Meter:
    """Advance by a duration in document time, paced to the wall clock (Lomp et al. 2016, section 3.2).

    A step is taken when its time has come, and all that are due are taken together, for about 10 ms at most.
    Where the machine is too slow the run falls behind and says so in the meter; it catches up to 0.25 s, what
    is beyond is given up. Abstract time counts as milliseconds.

    Args:
        session: what runs.
        duration: document time; a whole number of steps.
        speed: document time over wall time: 1 is real time, less is slow motion; None: as fast as possible.
        longest_step: let the step grow up to this, in whole multiples of dt, where there is not enough time
            for dt. The result then depends on the machine; the journal of the session holds every change of
            dt with its tick, so that the run can be repeated. None: the step stays, and with it the result.
        between: called between two exchanges, for input and output of your own; it may read and set the
            session, and raise to stop.
        pace: the clock; none: a new one.
        sleep: how to wait, given seconds.

    Returns:
        The meter: real-time factor, lag, overruns, steps.

    Raises:
        TimeError: a duration that is no whole number of steps, a speed that is not above 0, a step above a
            time constant.
        KeyboardInterrupt: on Ctrl-C, between two exchanges; the session stays where it then is.
    """
    pace = pace or Pace()
    pace.longest = require_longest(session, longest_step)
    pace.speed = require_speed(speed)
    planned = session.next_dt
    whole(require_duration(duration, "a duration"), planned, "a duration")
    session.program.chunk(())  # compiled before time counts
    end = session.time + duration
    pace.lengthen(session)
    pace.restart()
    try:
        with stoppable() as check:
            while (left := _steps(end - session.time, session.dt)) > 0:
                check()
                together = session.program.plan.ticks
                if session.dt > planned and left <= 2 * together:
                    pace.shorten(session)  # a longer step would not end at the end
                    left = together
                elif session.dt > planned:
                    left -= 2 * together
                n = min(pace.due(session), left)
                if n == 0:
                    sleep(pace.rest(session))
                    continue
                before, began = session.time, time.perf_counter()
                session.step(n)
                pace.took(session, n, session.time - before, time.perf_counter() - began)
                if between is not None:
                    between()
                if end - session.time > 4 * session.program.plan.ticks * (pace.longest or session.next_dt):
                    pace.lengthen(session)
    finally:
        pace.shorten(session)
    return pace.meter(session)


def _steps(left: float, dt: float) -> int:
    """Steps that are left, to half a step; a step that is longer than what is left counts as one."""
    return 0 if left < 0.5e-6 * dt else max(1, math.floor(left / dt + 1e-6))
