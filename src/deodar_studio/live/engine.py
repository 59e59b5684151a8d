"""A session driven by the wall clock, in its own thread.

Only this thread accesses the session. Other threads pass functions to it (`call`), which it runs between two
exchanges, at most `EXCHANGE` apart; they read the state `published` last, which never changes. Compilation
runs in a second thread while the session continues; the engine switches to the new program between two
exchanges, with the states of all elements that remain.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import math
import queue
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from deodar.errors import ModelError, NotFinite, ParameterError, Problem, problems_of
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.session.cost import StepCost, costs
from deodar.session.exchange import used
from deodar.session.pace import Pace, require_longest
from deodar.session.port_reader import PortKey, PortReader, port_reader
from deodar.session.run import require_step
from deodar.session.session import Session
from deodar.session.session_snapshot import SessionSnapshot
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar_studio.live.branch_states import BranchStates
from deodar_studio.live.compilation import Compilation, CompileTimes
from deodar_studio.live.published import CostReport, PublishedState
from deodar_studio.live.ring import StateRing
from deodar_studio.live.trace import Trace, TraceRequest
from deodar_studio.live.track import Track
from deodar_studio.live.unwaited import UnwaitedThreads

T = TypeVar("T")
FRAME = 0.022
"""Shortest wall time between two shots, in seconds; screens show no more."""

HURRIED = 2
"""Number of shots after an edit that do not wait for FRAME, so that a hand on a slider sees what it does; the
first may show too few steps.
"""

SAMPLES = 4
"""Number of samples of a time course in one exchange; more would slow a fast run without being visible."""

MOST_LOOKS = 8

PARTING_SECONDS = 1.0
"""Longest wall time for which the end of the studio waits for the engine, in seconds; the world of a session
may itself wait for a robot.
"""


@dc.dataclass
class Injection:
    """An external input to an element, injected until it is released."""

    element: str
    amount: np.ndarray


class Engine:
    """Runs a session and publishes its state.

    Attributes:
        published: the state published last.
        running: whether the clock advances the session.
        attended: whether a page is open; without one, a run that moves a robot pauses.
        failure: why the run stopped, and the paths of the elements concerned.
        busy: a phrase for the compilation in progress; empty: none.
        compilation: the compilation in progress, or the last one.
        compile_times: how long programs took to compile.
        pace: requested and achieved speed.
        cost_report: cost of elements, as last measured.
        traces: time courses by their specification; only the engine adds samples.
        track: the world from above, and the paths of its bodies.
        ring: the states published in the last minute; a reset or another session begins a new one.
        states: whole states of that minute, from which the run can continue.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._calls: queue.SimpleQueue[tuple[Callable[[], Any], Future[Any]]] = queue.SimpleQueue()
        self._wake = threading.Event()
        self._closed = False
        self._requested = True
        self._stale = True
        self._hurried = 0
        self._published_at = 0.0
        self._places: frozenset[PortKey] = frozenset()
        self._readers: list[PortReader] = []
        self._reader: PortReader | None = None
        self._sample: PortReader | None = None
        self._target: tuple[Model, Document] | None = None
        self._making: Future[Any] | None = None
        self._steps = 0
        self._uncompiled = False
        self._moved: World | None = None
        self._last_world: World | None = None
        self._compiler = UnwaitedThreads(2, "deodar-compiler")  # one to compile, one to measure
        self._thread = threading.Thread(target=self._loop, name="deodar-engine", daemon=True)
        self.session: Session | None = None
        self.injection: Injection | None = None
        self.traces: dict[TraceRequest, Trace] = {}
        self.published = PublishedState(0, 0.0, 0, {})
        self.running = False
        self.attended = True
        self.failure: tuple[tuple[Problem, ...], tuple[str, ...]] = ((), ())
        self.busy = ""
        self.compilation: Compilation | None = None
        self.compile_times = CompileTimes()
        self.pace = Pace()
        self.cost_report = CostReport()
        self.track = Track()
        self.ring = StateRing()
        self.states = BranchStates()
        self._thread.start()

    # ------------------------------------------------------------------------------------- from other threads

    def call(self, function: Callable[[], T]) -> Future[T]:
        """Run a function in the engine's thread between two exchanges."""
        future: Future[T] = Future()
        self._calls.put((function, future))
        self._wake.set()
        return future

    def want(self) -> None:
        """Request another state; none is published without a request."""
        self._requested = True
        self._wake.set()

    def close(self) -> None:
        """Stop the engine's thread, put motors to rest, and leave a compilation unfinished.

        A record whose session does not stop in time is left as a killed run leaves it.
        """
        self._closed = True
        self._wake.set()
        self._compiler.shutdown()
        self._thread.join(PARTING_SECONDS)
        try:
            self._halt()
        finally:
            if not self._thread.is_alive():
                self.stop_record()

    def working(self) -> bool:
        """Return whether a thread still works after `close`."""
        return self._compiler.working(0.1) or self._thread.is_alive()

    # ----------------------------------------------------------------- in the engine's thread, through `call`

    def load(self, session: Session | None, leave: bool = False) -> None:
        """Use another session. It is paused, unless `play` or `step` was called while there was none.

        Args:
            session: the other session; None: none until the next call.
            leave: whether the robot of the session before is left; False if that session may return.
        """
        self.stop_record()
        self._halt()
        self._last_world = self._last_world if self.session is None else self.session.world
        waited = self.session is None and session is not None
        self.running, self._steps = self.running and waited, self._steps if waited else 0
        self.session, self.injection, self._target = session, None, None
        self.failure, self._reader, self._sample = ((), ()), None, None
        self._uncompiled = False
        self._readers.clear()
        speed, self.pace, self.cost_report = self.pace.speed, Pace(), CostReport()
        self.pace.speed = speed
        self.restart()
        self._make()
        if leave and session is not None:
            _leave(self._last_world, session.world)

    def record(self, path: Path, ports: Sequence[str], every: float | None = None) -> None:
        """Record ports into a new folder from now on."""
        self._require().record(path, ports, every)
        self._stale = True

    def stop_record(self) -> None:
        """Complete the record that is being written, if any."""
        if self.session is not None and self.session.recorder is not None:
            self.session.recorder.close()
        self._stale = True

    def play(self, running: bool) -> None:
        """Start or pause the run."""
        self.running = running
        self._steps, self.failure = 0, ((), ()) if running else self.failure
        self._keep_step()
        self.pace.restart()
        self._stale = True

    def step(self, n: int) -> None:
        """Advance by `n` steps, then pause."""
        self.play(False)
        self._steps = n
        self.failure = ((), ())

    def reset(self, seed: int | None = None) -> None:
        """Reset state, time and noise to the start."""
        if self.session is not None:
            self.session.reset(seed)
        self.failure = ((), ())
        self.restart()

    def branch(self, time: float) -> Document:
        """Go back to the last published moment up to a time, and return the document of that moment.

        The state has the bits that it had then; what was published later is forgotten. The run pauses. If an
        error occurs, the run is as it was.

        Raises:
            RecordError: the moment cannot be computed again.
        """
        session, published = self._require(), self.ring.at(time)
        if published is None:
            raise ModelError("The run has no moment to continue from", fix="Start it first")
        state = published[1]
        # all that may fail comes before the session goes back
        ring = self.ring.until(state.tick)
        traces = {request: trace.until(state.time) for request, trace in self.traces.items()}
        self._keep_step()
        try:
            self.states.branch(session, state.tick, self._report)
        finally:
            self.busy, self._stale = "compiling" if self._target else "", True
        self.play(False)
        self.busy, self._target, self.injection = "", None, None
        self.ring, self.traces = ring, traces
        self.track.back(session, state.trail, state.passed)
        if session.next_dt != session.document.step:  # a step that was lengthened
            session.dt = session.document.step
        self._make()
        return session.document

    def snapshot(self) -> SessionSnapshot:
        """Return the whole state of the run."""
        return self._require().snapshot()

    def restore(self, snapshot: SessionSnapshot) -> None:
        """Return to a snapshot, and begin a new past. The run pauses.

        Raises:
            ParameterError: the snapshot is of another model.
        """
        session = self._require()
        session.restore(snapshot)
        self.play(False)
        self.busy, self._target, self.injection = "", None, None
        if session.next_dt != session.document.step:  # a step that was lengthened
            session.dt = session.document.step
        self.failure = ((), ())
        self.restart()
        self._make()

    def _report(self, done: int, steps: int) -> None:
        if self._closed:
            raise ModelError("the studio ends")
        self.busy = f"computing the moment again, {100 * done // max(steps, 1)} %"
        self._changed()

    def restart(self) -> None:
        """Clear the time courses and the stored states, and restart the pace."""
        self.ring = StateRing()
        self.states = BranchStates()
        for request in self.traces:
            self.traces[request] = Trace()
        self.pace.restart()
        self._stale = True

    def adopt(self, model: Model, document: Document) -> str:
        """Continue with another document: at once if no compilation is needed, else when it is compiled.

        Return the cost.
        """
        session = self.session
        if session is None:
            return "recompile"
        self._keep_step()
        session.require(document)
        require_step(document, document.step)
        cost = session.cost(document)
        if cost != "recompile":
            session.edit(document)
            self._target = None
            self._hurried = HURRIED
            self._forgive()
        else:
            self._target = (model, document)
            self._make()
        if session.dt != document.step:
            session.dt = document.step
        self._stale = True
        return cost

    def lengthen(self, longest: float | None) -> None:
        """Let the step grow up to `longest` if the machine is too slow; None: the step is constant."""
        session = self._require()
        self._keep_step()
        self.pace.longest = require_longest(session, longest)

    def measure(self) -> None:
        """Measure the present cost of elements in the second thread, while the run continues.

        The result is in `cost_report`.
        """
        session = self._require()
        if self.cost_report.measuring:
            return
        self.cost_report, at = CostReport(True, self.cost_report.costs), session.moment()
        measurement = self._compiler.submit(lambda: costs(at))
        measurement.add_done_callback(
            lambda future: self._closed or self.call(lambda: self._billed(session, future))
        )

    def see(self, world: World) -> None:
        """Use another world. A robot that it replaces is left, and may be commanded by others again.

        After an error the world in use stays.
        """
        self._halt()
        if self.session is not None:
            replaced = self.session.world
            if _same_robot(replaced, world):  # it obeys one commander
                _leave(replaced, world)
            self.session.world = world
            if any(each is not None and each.can_narrow for each in (world, replaced)):
                self.states.forget()  # they have the motors of another world, or other limits
            if not _same_robot(replaced, world):
                _leave(replaced, world)
        self.failure, self._stale = ((), ()), True

    def narrow(self, motor: str, limits: tuple[float, float] | None, slew: float | None) -> None:
        """Narrow what a motor of the world allows; the run returns to no moment before."""
        self._require().narrow_motor(motor, limits, slew)
        self.states.forget()
        self._stale = True

    def rearrange(self, how: Callable[[Session], None]) -> None:
        """Change the world: `how` calls `Session.move`, `place`, `remove` or `push_body`."""
        how(self._require())
        self._stale = True

    def inject(self, injection: Injection | None) -> None:
        """Inject an external input into the running model; None releases it."""
        if injection is not None and self.session is not None:
            self.session.require_injection(injection.element)
        self.injection = injection
        self._stale = True

    def show(self, places: Iterable[PortKey], requests: Iterable[TraceRequest]) -> None:
        """Set the places that shots contain from now on, and the time courses that are sampled."""
        self._places = frozenset(places)
        traces = self.traces
        self.traces = {r: traces[r] if r in traces else self._trace_so_far(r) for r in requests}
        self._make()
        self._stale = True

    # ----------------------------------------------------------------------------------------------- the loop

    def _loop(self) -> None:
        while not self._closed:
            self._wake.clear()
            self._run_calls()
            try:
                wait = self._exchange()
                self._publish()
            except Exception as error:  # an error of an element becomes `failure`; the engine continues
                wait = 0.02
                self._fail(error)
            if wait > 0:
                self._wake.wait(wait)

    def _run_calls(self) -> None:
        while not self._calls.empty():
            function, future = self._calls.get()
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(function())
                except BaseException as error:
                    future.set_exception(error)
                self._changed()

    def _exchange(self) -> float:
        """Take the steps that are due; return the wall time until the next one, in seconds."""
        session = self.session
        if not self.attended and (self.running or self._steps) and _moves_robot(session):
            self._leave_robot()
        if session is None or not (self.running or self._steps):
            self._halt()
            return 0.02 if self._stale and self._requested else 0.5
        if self._steps and self._making is not None and self._target is None:
            return 0.02  # time courses that were just requested shall have these steps
        n = min(self._steps, self.pace.most(session)) if self._steps else self.pace.due(session)
        if n == 0:
            return self.pace.rest(session)
        parts = max(1, min(n, SAMPLES)) if self.traces or self.track.scene is not None else 1
        before, began = session.time, time.perf_counter()
        for k in range(parts):
            self._advance(session, n * (k + 1) // parts - n * k // parts)
            self._take_samples(session)
            self.track.follow(session)
        self.pace.took(session, n, session.time - before, time.perf_counter() - began)
        if self.running:
            self.pace.lengthen(session)
        self._steps = max(0, self._steps - n)
        if self._hurried:
            self._published_at = -math.inf
        self._stale = True
        return 0.0

    def _halt(self) -> None:
        """Put the motors of a robot to rest, once after the last step of a run."""
        moved, self._moved = self._moved, None
        if moved is not None:
            with errors_of(moved, "halt"):
                moved.halt()

    def _leave_robot(self) -> None:
        """Pause the run, because no page is there by which anybody could stop the robot."""
        self.play(False)
        fix = "Start it again; with deodar studio --unattended it continues without a page"
        absence = Problem("", "the run that moves a robot has paused, because no page was open", fix)
        self.failure = ((absence,), ())
        self._changed()

    def _advance(self, session: Session, n: int) -> None:
        self._moved = session.world
        self.states.follow(session)
        injection = self.injection
        entry = session.document.by_id().get(injection.element) if injection is not None else None
        if injection is not None and entry is not None:
            session.inject(entry.path, injection.amount, n)
        else:
            session.step(n)

    def _require(self) -> Session:
        if self.session is None:
            raise ModelError("no model runs yet", fix="Wait until it is compiled")
        return self.session

    def _keep_step(self) -> None:
        """Return to the planned step, so that an edit is not refused because of a lengthened one."""
        if self.session is not None:
            self.pace.shorten(self.session)

    def _take_samples(self, session: Session, lacking: bool = False) -> None:
        """Add the present values to the time courses; with `lacking` to those without this moment."""
        sample = self._sample
        if not self.traces or sample is None or sample.program is not session.program:
            return
        arrays = self._with_injection(
            session.read_ports(sample, {request.place for request in self.traces}), session
        )
        for request, trace in self.traces.items():
            if request.place in arrays and not (lacking and trace.newest == session.time):
                axes = session.program.axes(session.program.port(*request.place))
                trace.add(session.time, request.value(arrays[request.place], axes))

    def _take_first(self, session: Session) -> None:
        """Take the present sample of new time courses, also during a pause."""
        if any(trace.newest != session.time for trace in self.traces.values()):
            self._take_samples(session, lacking=True)
            self._stale = True

    def _trace_so_far(self, request: TraceRequest) -> Trace:
        """Return a new time course with samples of the stored states that contain its port."""
        trace, session = Trace(), self.session
        if session is None or request.place[0] not in session.program.plan.row:
            return trace
        with contextlib.suppress(KeyError):  # a port that does not exist
            axes = session.program.axes(session.program.port(*request.place))
            shape = tuple(a.samples for a in axes)
            for state in self.ring.states():
                array = state.arrays.get(request.place)
                if array is not None and array.shape == shape:
                    trace.add(state.time, request.value(array, axes))
        return trace

    def _with_injection(
        self, arrays: Mapping[PortKey, np.ndarray], session: Session
    ) -> Mapping[PortKey, np.ndarray]:
        """Add an injected input to the published input of its element."""
        entry = session.document.by_id().get(self.injection.element) if self.injection is not None else None
        if self.injection is None or entry is None:
            return arrays
        place = (entry.id, entry.element.ports()[0])
        return {**arrays, place: arrays[place] + self.injection.amount} if place in arrays else arrays

    def _publish(self) -> None:
        """Publish the state if it changed, one was requested, and the last one is older than FRAME."""
        wall = time.perf_counter()
        if not (self._stale and self._requested) or wall - self._published_at < FRAME:
            return
        # before the state is published, because its readers may request the next one at once
        self._stale, self._requested = False, False
        session, seen = self.session, self._reader
        arrays: Mapping[PortKey, np.ndarray] = {}
        if session is not None and seen is not None and seen.program is session.program:
            arrays = self._with_injection(session.read_ports(seen, self._places), session)
        self.track.follow(session)
        moment = (session.time, session.tick) if session is not None else (0.0, 0)
        track = self.track
        self.published = PublishedState(
            self.published.number + 1, *moment, arrays, track.scene, track.trail, len(track.trail.places)
        )
        if session is not None and (arrays or not self._places):  # else their reader is being compiled
            self.ring.add(self.published, wall)
        self._published_at, self._hurried = wall, max(0, self._hurried - 1)
        self._changed()

    def _fail(self, error: Exception) -> None:
        self.running, self._steps, self.injection = False, 0, None
        paths = error.paths if isinstance(error, NotFinite) else ()
        self.failure, self._stale = (problems_of(error), paths), True
        self._changed()

    def _forgive(self) -> None:
        """Clear the failure of an edit that could not be compiled, after another edit that can."""
        if self._uncompiled:
            self._uncompiled, self.failure = False, ((), ())

    def _billed(self, session: Session, future: Future[StepCost]) -> None:
        if session is self.session:
            error = future.exception()
            self.cost_report = (
                CostReport(costs=future.result())
                if error is None
                else CostReport(problems=problems_of(error))
            )

    # ------------------------------------------------------------------------------- compiling beside the run

    def _make(self) -> None:
        """Compile the program of the target, and a `PortReader` for places and time courses, unless known."""
        session = self.session
        if session is None or self._making is not None:
            return
        model, document = self._target or (None, session.document)
        places_read = (self._places, frozenset(request.place for request in self.traces))
        readers, program = list(self._readers), session.program

        compilation = self.compile_times.start(document)

        def make() -> tuple[Any, list[PortReader]]:
            compiled = program
            if model is not None:
                compiled = session.compiled(document, model)
                compilation.phase = "compiling"
                session.precompile(compiled)
                if compiled.compiled:
                    self.compile_times.took(document, compilation.elapsed)
            return compiled, [
                _found(readers, compiled, places) or port_reader(compiled, places) for places in places_read
            ]

        fitting = [_found(readers, program, places) for places in places_read]
        if model is None and fitting[0] is not None and fitting[1] is not None:
            self._reader, self._sample = fitting[0], fitting[1]
            self._take_first(session)
            return
        if model is not None:
            self.busy, self.compilation = "compiling", compilation
        self._making = self._compiler.submit(make)
        self._making.add_done_callback(
            lambda future: (
                self._closed or self.call(lambda: self._take_compiled(session, document, places_read, future))
            )
        )

    def _take_compiled(
        self,
        session: Session,
        document: Document,
        places_read: tuple[frozenset[PortKey], ...],
        future: Future[Any],
    ) -> None:
        self._making, self.busy, self._stale = None, "", True
        if session is not self.session:
            return self._make()
        self._keep_step()
        try:
            program, (at_shown, at_sampled) = future.result()
            self._readers = [
                *(reader for reader in self._readers if reader not in (at_shown, at_sampled)),
                at_shown,
                at_sampled,
            ][-MOST_LOOKS:]
            if document is not session.document and self._target is not None and self._target[1] is document:
                self._continue(session, document)
            elif self._target is not None and session.cost(self._target[1]) != "recompile":
                self._continue(session, self._target[1])
        except Exception as error:  # the program that runs continues
            self._target, self._uncompiled = None, True
            self.failure = (problems_of(error), ())
            return None
        if session.program is program:
            self._reader, self._sample = at_shown, at_sampled
            self._take_first(session)
        places_now = (self._places, frozenset(request.place for request in self.traces))
        if self._target is not None or places_now != places_read or session.program is not program:
            self._make()
        return None

    def _continue(self, session: Session, document: Document) -> None:
        """Continue with a document that was accepted when its compilation began.

        A state that had nothing to lose then, and cannot be carried now, begins again with the whole run.
        """
        try:
            session.require(document)
        except ParameterError:
            self.reset()
        session.edit(document)
        self._target = None
        self._forgive()


def _moves_robot(session: Session | None) -> bool:
    """Return whether a session has motors of a world that follows the wall clock."""
    world = None if session is None else session.world
    if session is None or world is None or not world.stage.wall_clock:
        return False
    return bool(used(session.document, world)[1])


def _same_robot(replaced: World | None, world: World) -> bool:
    """Return whether two worlds are links with one robot."""
    before, after = None if replaced is None else replaced.link(), world.link()
    return before is not None and after is not None and before.robot == after.robot


def _leave(replaced: World | None, world: World | None) -> None:
    """Leave the robot of a world that another one replaces."""
    if replaced is not None and replaced is not world and replaced.link() is not None:
        with errors_of(replaced, "close"):
            replaced.close()


def _found(readers: Sequence[PortReader], program: Any, places: Iterable[PortKey]) -> PortReader | None:
    """Return a known `PortReader` of a program that reads exactly the groups of these places, or None."""
    return next((reader for reader in readers if reader.program is program and reader.fits(places)), None)
