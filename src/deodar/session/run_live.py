"""Run a session paced to the wall clock, for scripts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from deodar.session.interrupt import stoppable
from deodar.session.meter import Meter
from deodar.session.pace import Pace, Paced, require_longest, require_speed
from deodar.session.run import require_duration, whole
from deodar.worlds._failure import errors_of


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

    A step is taken when the wall clock reaches its time; all steps that are due are taken together, for about
    10 ms at most. If the machine is too slow, the run falls behind, and the meter shows the lag; the run
    catches up a lag of up to 0.25 s and drops the rest. Abstract time counts as milliseconds. An error or
    Ctrl-C puts the motors of a robot in another process to rest.

    Args:
        session: the session to run.
        duration: document time; a whole number of steps.
        speed: ratio of document time to wall time: 1 is real time, less is slow motion; None: as fast as
            possible.
        longest_step: let the step grow up to this length, in whole multiples of dt, if there is not enough
            time for dt. The result then depends on the machine; the journal of the session has every change
            of dt with its tick, so that the run can be repeated. None: the step is constant, and so is the
            result.
        between: called between two exchanges, for custom input and output; it may read and set the session,
            and raise an exception to stop.
        pace: the pace to use; None: a new one.
        sleep: function that waits for a number of seconds.

    Returns:
        The meter: real-time factor, lag, overruns, steps.

    Raises:
        TimeError: the duration is not a whole number of steps, the speed is not above 0, or the longest step
            is above the limit of a time constant.
        KeyboardInterrupt: on Ctrl-C, between two exchanges; the session keeps the state reached.
    """
    pace = pace or Pace()
    pace.longest = require_longest(session, longest_step)
    pace.speed = require_speed(speed)
    planned = session.next_dt
    whole(require_duration(duration, "a duration"), planned, "a duration")
    session.program.chunk(())  # compiled before the clock starts
    end = session.time + duration
    pace.lengthen(session)
    pace.restart()
    try:
        with stoppable() as check:
            while (steps_left := _steps(end - session.time, session.dt)) > 0:
                check()
                together = session.program.plan.ticks
                if session.dt > planned and steps_left <= 2 * together:
                    pace.shorten(session)  # a longer step would not stop exactly at the end
                    steps_left = together
                elif session.dt > planned:
                    steps_left -= 2 * together
                n = min(pace.due(session), steps_left)
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
    except BaseException:
        if session.world is not None:
            with errors_of(session.world, "halt"):
                session.world.halt()
        raise
    finally:
        pace.shorten(session)
    return pace.meter(session)


def _steps(time_left: float, dt: float) -> int:
    """Return the number of steps left; a rest that is shorter than a step counts as one."""
    return 0 if time_left < 0.5e-6 * dt else max(1, math.floor(time_left / dt + 1e-6))
