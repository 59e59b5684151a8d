"""One trial: a model in its world, looked at at regular times, with actions on the way, until an event or the limit ends it."""

from __future__ import annotations

import contextlib
import copy
from collections.abc import Callable, Generator, Sequence
from typing import Any

import numpy as np

from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.errors import ParameterError, TimeError
from deodar.experiments.actions import Action, Set, arena
from deodar.experiments.course import TIME, Course, Notes
from deodar.experiments.events import Event
from deodar.model import find
from deodar.model.model import Model
from deodar.numerics.axes import Axes, Axis
from deodar.runtime.look import Look, look
from deodar.runtime.run import whole
from deodar.runtime.session import Session
from deodar.runtime.unit import unit_seconds
from deodar.worlds._base import World


def run(
    model: Model,
    limit: float,
    world: World | None = None,
    seed: int = 0,
    trial: int = 0,
    watch: Sequence[str] = (),
    events: Sequence[Event] = (),
    actions: Sequence[Action] = (),
    every: float | None = None,
    dt: float | None = None,
    precision: str = "float32",
    between: Callable[[], None] | None = None,
) -> Course:
    """Run one trial and return its course.

    The first look is at the start. At a time at which something is done, the look comes first: what is done shows one step (for a world, one
    period) later. The same arguments give the same course, whatever ran before; things that actions moved in the world are put back.

    Args:
        model: the model, as it now is.
        limit: document time after which the trial ends at the latest.
        world: what its sensors read and its motors move; of starts and goals given for each trial it takes those of this one.
        seed: seed of all noise.
        trial: which trial of the seed it is.
        watch: paths of ports and names of sensors of the world to look at, besides those that events need.
        events: what may happen; those that `ends` says end the trial.
        actions: what is done, at which times.
        every: document time between looks; none: dt.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
        between: called after each look; what it raises ends the trial.
    """
    session = Session(model, dt, seed, precision, world, trial)
    steps, gap = whole(limit, session.dt, "the limit"), 1 if every is None else whole(every, session.dt, "every")
    if gap == 0:
        raise TimeError("every is 0; it is at least one step")
    require(events)
    due = sorted((whole(a.at, session.dt, "the time of an action"), k) for k, a in enumerate(actions))
    wanted = list(dict.fromkeys([*watch, *(name for e in events for name in e.needs)]))
    eye = _Eye(session, wanted)
    notes = Notes(events)
    with _put_back(world, actions):
        while True:
            look = eye.see()  # also where only an action is due: it finds the world at its moment
            if session.tick % gap == 0 or session.tick == steps:
                notes.take(session.time, look, session.tick == steps)
                if between is not None:
                    between()
            if notes.outcome:
                return notes.course(wanted)
            while due and due[0][0] <= session.tick:
                actions[due.pop(0)[1]].apply(session)
            ahead = gap - session.tick % gap
            session.step(min([ahead, steps - session.tick, *([due[0][0] - session.tick] if due else [])]))


class _Eye:
    """Reads what is looked at: all ports by one program, then sensors of the world, which that has brought to the present."""

    def __init__(self, session: Session, wanted: Sequence[str]) -> None:
        self.session = session
        sensors = () if session.world is None else session.world.sensors
        self.sensors = [name for name in wanted if name in sensors]
        self.ports = {name: find.port(session.document, name) for name in wanted if name not in sensors}
        self.places = [(entry.id, port) for entry, port in self.ports.values()]
        if session.world is not None and not self.places:  # reading a port of what is tied to the world brings the world to the present
            tied = [e.id for e in session.document.entries if isinstance(e.element, (Motor, Sensor))]
            self.places = [(ident, "output") for ident in tied[:1]]
        self.look: Look = look(session.program, self.places)

    def see(self) -> dict[str, np.ndarray]:
        session = self.session
        if self.look.program is not session.program:  # an action compiled another one
            self.look = look(session.program, self.places)
        arrays = session.look(self.look, self.places)
        out = {name: np.array(arrays[entry.id, port]) for name, (entry, port) in self.ports.items()}
        world, moment = session.world, session.time * unit_seconds(session.document.time_unit) * 1e3
        for name in self.sensors:
            assert world is not None
            signal = world.sensors[name]
            if signal.shape is None:
                raise ParameterError("is sampled over axes that a model states", where=name, fix="Watch the port of a Sensor that reads it")
            reading = world.sense(name, _axes(signal.shape), moment)
            out[name] = np.array(reading[0] if signal.each else reading)
        return out


def _axes(shape: Sequence[int]) -> Axes:
    return tuple(Axis(f"of {k}", 0.0, float(max(n - 1, 1)), n) for k, n in enumerate(shape))


def require(events: Sequence[Event]) -> None:
    """Refuse events that rows could not tell apart."""
    names = [e.name for e in events]
    twice = next((n for n in names if names.count(n) > 1 or n == TIME), None)
    if twice is not None:
        raise ParameterError("is the name of two events, or of the limit", where=twice, fix="Give each event a name of its own")


@contextlib.contextmanager
def _put_back(world: World | None, actions: Sequence[Action]) -> Generator[None]:
    """Things in the world as they were, when the trial is over."""
    if not any(not isinstance(a, Set) for a in actions):
        yield
        return
    here = arena(world)
    before: Any = copy.deepcopy(here.furniture)
    try:
        yield
    finally:
        here.furniture = before
