"""Run a session paced to the wall clock, for scripts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from deodar.errors import TimeError, show
from deodar.parameters import real
from deodar.session.interrupt import stoppable
from deodar.session.meter import Meter
from deodar.session.pace import Pace, Paced, require_longest, require_speed
from deodar.session.run import require_duration, whole
from deodar.worlds._failure import errors_of

BETWEEN_EVERY = 50.0
"""Wall time between two calls of a function of the user, in ms: a plot that is drawn so often is smooth."""

SHARE = 4
"""Wall time from the beginning of a call to the next one, in durations of the call: calls that take longer
than the time between them would hold up the run.
"""


def run_live(
    session: Paced,
    duration: float,
    speed: float | None = 1.0,
    longest_step: float | None = None,
    between: Callable[[], object] | None = None,
    between_every: float = BETWEEN_EVERY,
    pace: Pace | None = None,
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
            and raise an exception to stop. The last call is at the end of the run.
        between_every: wall time between two calls of `between`, in ms; 0: at each exchange, about every
            10 ms. A call that takes long, such as a plot, is repeated less often, so that the calls take at
            most a quarter of the wall time.
        pace: the pace to use; None: a new one.

    Returns:
        The meter: real-time factor, lag, overruns, steps.

    Raises:
        TimeError: the duration is not a whole number of steps, the speed is not above 0, the longest step is
            above the limit of a time constant, or `between_every` is below 0.
        KeyboardInterrupt: on Ctrl-C, between two exchanges; the session keeps the state reached.
    """
    pace = pace or Pace()
    pace.longest = require_longest(session, longest_step)
    pace.speed = require_speed(speed)
    call = _at_rate(between, between_every, pace.clock)
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
                    pace.sleep(pace.rest(session))
                    continue
                before, began = session.time, time.perf_counter()
                session.step(n)
                pace.took(session, n, session.time - before, time.perf_counter() - began)
                call(_steps(end - session.time, session.dt) == 0)
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


def _at_rate(
    between: Callable[[], object] | None, every: float, clock: Callable[[], float]
) -> Callable[[bool], None]:
    """Return a function that calls `between` if that is due, and always at the end of the run."""
    least, due = real(every), -math.inf
    if least is None or not 0 <= least < math.inf:
        raise TimeError(f"between_every is {show(every)}; expected a number of ms, 0 or above")

    def call(last: bool) -> None:
        nonlocal due
        if between is None or (clock() < due and not last):
            return
        began = clock()
        between()
        due = began + max(1e-3 * least, SHARE * (clock() - began))

    return call


def _steps(time_left: float, dt: float) -> int:
    """Return the number of steps left; a rest that is shorter than a step counts as one."""
    return 0 if time_left < 0.5e-6 * dt else max(1, math.floor(time_left / dt + 1e-6))
