"""One trial, sampled at regular intervals, with actions, until an event or the limit ends it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Generator, Mapping, Sequence

import numpy as np

from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.errors import NotFinite, ParameterError, TimeError
from deodar.experiments.actions import Action, Record, Reset, require_targets
from deodar.experiments.actions import require as require_actions
from deodar.experiments.events import Event
from deodar.experiments.measures import BaseMeasure
from deodar.experiments.observable import Observable
from deodar.experiments.observations import DIVERGED, Observations
from deodar.experiments.pushes import with_pushes
from deodar.experiments.running import SessionTrial
from deodar.experiments.trial import Trial
from deodar.model import find
from deodar.model.model import Model
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import Axes, Axis
from deodar.session.clock import Clock
from deodar.session.failure import not_finite
from deodar.session.port_reader import PortReader, port_reader
from deodar.session.run import whole
from deodar.session.session import Session, require_model
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of


def run_trial(
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
    measures: Sequence[BaseMeasure] = (),
    tolerant: bool = False,
) -> Trial:
    """Run one trial and return its result.

    The first sample is at the start. At the time of an action the trial is sampled before the action: its
    effect shows one step (for a world, one period) later. The same arguments give the same result,
    independent of earlier trials; objects that actions moved in the world are restored.

    Args:
        model: the model in its present state.
        limit: document time after which a trial times out.
        world: the world of the model's sensors and motors; if its starts and goals are given per trial, those
            of this trial are used.
        seed: seed of all noise.
        trial: number of the trial of the seed.
        watch: paths of ports and names of sensors of the world whose values are returned; the path of a field
            alone means its activation.
        events: the events to detect; events with `ends` end the trial.
        actions: the actions, at their times or after their events.
        every: sampling interval in document time; none: dt.
        dt: Euler step; none: the document's own.
        precision: float32 or float64.
        between: function that is called after each sample; an exception that it raises ends the trial.
        measures: the measures of the trial.
        tolerant: return a trial that diverges, with the outcome `diverged`, its `error`, and NaN as its
            values.

    Raises:
        NotFinite: the trial diverges, unless `tolerant`.
    """
    require_actions(actions, world)
    observed = Observations(events, measures, 1)
    require_targets(actions, [e.name for e in events], require_model(model).document)
    staged, pushes = with_pushes(require_model(model), actions)
    session = Session(staged, dt, seed, precision, world, trial)
    steps, gap = (
        whole(limit, session.dt, "the limit"),
        1 if every is None else whole(every, session.dt, "every"),
    )
    if gap == 0:
        raise TimeError("every is 0; expected at least one step")
    running = SessionTrial(session, trial, actions, pushes, any(isinstance(a, Reset) for a in actions))
    running.recording = not any(isinstance(a, Record) and a.on for a in actions)
    sampler = _Sampler(session, watch, [*(v for e in events for v in e.views), *(m.view for m in measures)])
    times, recorded, kept = list[float](), list[float](), list[dict[str, np.ndarray]]()
    values: dict[str, np.ndarray] = {}
    lost: NotFinite | None = None

    def keep(values: dict[str, np.ndarray]) -> None:
        times.append(session.time)
        if running.recording:
            recorded.append(session.time)
            kept.append(values)

    try:
        with _put_back(world, actions):
            while True:
                values, seen = sampler.sample()  # also at an action alone: the world must be at its time
                looked = session.tick % gap == 0 or session.tick == steps
                if looked:
                    keep(values)
                    observed.take([0], np.asarray([session.time]), seen, session.tick == steps)
                    if between is not None:
                        between()
                    running.notice(observed.events_of(0))
                if not observed.outcome[0]:
                    running.do()
                    if running.outcome:
                        if not looked:
                            keep(values)
                        observed.end(0, running.outcome, seen, 0)
                if observed.outcome[0]:
                    break
                now, due = session.tick, running.due
                session.step(min(gap - now % gap, steps - now, steps if due is None else due - now))
    except NotFinite as error:
        if not tolerant:
            raise
        lost, observed.outcome[0] = error, DIVERGED
        kept = [{name: np.full_like(a, np.nan) for name, a in values.items()} for values in kept]
    stacked = {
        name: np.stack([v[name] for v in kept])
        if kept
        else np.zeros((0, *(values[name].shape if name in values else ())))
        for name in watch
    }
    events_, measures_ = observed.events_of(0), observed.measures_of(0, sampler.axes())
    return Trial(
        np.asarray(times),
        stacked,
        events_,
        observed.outcome[0],
        measures_,
        np.asarray(recorded),
        running.snapshots,
        lost,
    )


class _Sampler:
    """Samples all ports by one program, then the sensors of the world, which the program has brought up to
    date.
    """

    def __init__(self, session: Session, watch: Sequence[str], views: Sequence[Observable]) -> None:
        self.session, self.watch, self.views = session, watch, tuple(dict.fromkeys(views))
        known = () if session.world is None else session.world.sensors
        self.sensors = {name for name in [*watch, *(v.of for v in views)] if name in known}
        self.ports: dict[str | Observable, tuple[str, str]] = {}
        for name in [n for n in watch if n not in self.sensors]:
            entry, port = find.shown(session.document, name)
            self.ports[name] = entry.id, port
        for view in [v for v in self.views if v.of not in self.sensors]:
            entry, port = view.place(session.document)
            self.ports[view] = entry.id, port
        self.places = list(dict.fromkeys(self.ports.values()))
        # reading a port that is connected to the world brings the world up to date
        if session.world is not None and not self.places:
            tied = [e.id for e in session.document.entries if isinstance(e.element, (Motor, Sensor))]
            self.places = [(ident, "output") for ident in tied[:1]]
        self.reader: PortReader = port_reader(session.program, self.places)

    def sample(self) -> tuple[dict[str, np.ndarray], dict[Observable, np.ndarray]]:
        """Return the values of the watched ports, and the value of each view, as one sample of one trial."""
        session = self.session
        if self.reader.program is not session.program:  # an action compiled another one
            self.reader = port_reader(session.program, self.places)
        arrays = session.read_ports(self.reader, self.places)
        self._require_finite(arrays)
        sensed = self._sensed()
        values = {
            name: sensed[name] if name in sensed else np.array(arrays[self.ports[name]])
            for name in self.watch
        }
        seen: dict[Observable, np.ndarray] = {}
        for view in self.views:
            raw, axes = (
                (sensed[view.of], None) if view.of in sensed else (arrays[self.ports[view]], self._axes(view))
            )
            seen[view] = view.seen(raw[None, None], axes, 2)
        return values, seen

    def _require_finite(self, arrays: Mapping[tuple[str, str], np.ndarray]) -> None:
        """Refuse ports that are not finite although all states are, as a batch does: the output of a coupling
        may be infinite.
        """
        session = self.session
        for (ident, port), values in arrays.items():
            entry = session.document.by_id()[ident]
            good = np.isfinite(values) | (np.isnan(values) if port in entry.element.undefined() else False)
            if not good.all():
                clock = Clock(session.tick, session.time, session.tick, session.dt)
                raise not_finite([f"{entry.path}.{port}"], clock, session.document.time_unit)

    def axes(self) -> dict[Observable, Axes | None]:
        """Return for each view the axes of what it samples; None for a sensor."""
        return {view: None if view.of in self.sensors else self._axes(view) for view in self.views}

    def _axes(self, view: Observable) -> Axes:
        program = self.session.program
        return program.axes(program.port(*self.ports[view]))

    def _sensed(self) -> dict[str, np.ndarray]:
        world, names = self.session.world, sorted(self.sensors)
        if world is None:
            return {}
        requests: list[tuple[str, Axes]] = []
        for name in names:
            shape = world.sensors[name].shape
            if shape is None:
                raise ParameterError(
                    "is sampled over axes that a model states",
                    where=name,
                    fix="Watch the port of a Sensor that reads it",
                )
            requests.append((name, _axes(shape)))
        moment = self.session.time * unit_seconds(self.session.document.time_unit) * 1e3
        with errors_of(world, "sense"):
            readings = world.sense_all(requests, moment)
        return {
            name: np.array(reading[0] if world.sensors[name].each else reading)
            for name, reading in zip(names, readings, strict=True)
        }


def _axes(shape: Sequence[int]) -> Axes:
    return tuple(Axis(f"of {k}", 0.0, float(max(n - 1, 1)), n) for k, n in enumerate(shape))


@contextlib.contextmanager
def _put_back(world: World | None, actions: Sequence[Action]) -> Generator[None]:
    """Restore the changes of actions to the world after the trial."""
    if world is None or not any(a.world_method for a in actions):
        yield
        return
    with errors_of(world, "arrangement"):
        before = world.arrangement()
    try:
        yield
    finally:
        with errors_of(world, "arrange"):
            world.arrange(before)
