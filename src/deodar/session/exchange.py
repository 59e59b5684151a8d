"""The exchange between a model and its world, at each multiple of the world's period."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import jax
import numpy as np
from jax.typing import DTypeLike

from deodar import registry
from deodar.compiler.body import Body
from deodar.compiler.copy_batch import Batch
from deodar.compiler.executable import TrialNumbers
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import NotFinite, WorldError, option
from deodar.kind_errors import position
from deodar.model.document import Document
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import Axes, shape
from deodar.parameters import show
from deodar.recording import stored
from deodar.session import agreement
from deodar.worlds._base import Signal, World, fitting
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld

NEVER = 2**62
"""A tick that no run reaches."""

HELD = 1.5
"""Steps between two readings of a world from which what follows from readings alone is kept: at 1 step the
branch would be taken every time.
"""

MotorReader = Callable[[Sequence[str]], Sequence[np.ndarray]]
"""Function that returns the commands of motors (by id) in the present state of the model."""


@dc.dataclass(frozen=True)
class ExchangeInstant:
    """Time of an exchange: tick, document time, and milliseconds per unit of document time."""

    tick: int
    time: float
    unit: float


@dc.dataclass(frozen=True)
class StoredLeaves:
    """The leaves of the state of a world, from a file; the world itself has their structure."""

    leaves: Sequence[np.ndarray]


@dc.dataclass(frozen=True)
class WorldState:
    """State of a world and of its exchange.

    Attributes:
        kind: class of the world.
        world: the state that `World.keep` returned, or its leaves from a file.
        last: tick of the last exchange.
        due: tick of the next exchange.
        origin: tick from which periods are counted.
        commands: commands of the motors at the last exchange; None: not read yet.
        objects: what `World.arrangement` returned; None: nothing in the world can be moved.
    """

    kind: type[World]
    world: Any
    last: float
    due: int
    origin: int
    commands: Mapping[str, np.ndarray] | None
    objects: Any = None


class Exchange:
    """The exchange of a model with its world.

    The motors are read at t, and their effect on the sensors appears at t + period. This is the rule for
    every element with a step of its own, so that a run is the same wherever the world is computed.

    Attributes:
        world: the world, or None.
        sensors, motors: elements of the model that use it, by id.
    """

    def __init__(self, doc: Document, world: World | None) -> None:
        self.sensors, self.motors = used(doc, world)
        self.world = world
        self.body: Body | None = None
        self.unread = True
        self._last: float = 0
        self._due = self._origin = 0
        self._commands: Mapping[str, np.ndarray] | None = None
        self._readings: Sequence[np.ndarray] | None = None

    def require(self, doc: Document) -> None:
        """Raise WorldError for a document with a sensor or motor that the world does not have."""
        used(doc, self.world)

    @property
    def inside(self) -> bool:
        """Whether the world is computed inside the compiled step, so that nothing is exchanged here."""
        return self.body is not None

    def take(self, doc: Document) -> None:
        """Continue with another document. After an error nothing changed."""
        self.sensors, self.motors = used(doc, self.world)
        self.unread = True

    def reset(self, seed: int, trials: TrialNumbers, batch: Batch, precision: str) -> None:
        """Reset the world to its start, for a batch of copies."""
        if self.world is not None:
            numbers = trials if batch.own_noise else [trials] * (batch.points or 1)
            copies = np.ravel(np.asarray(numbers, np.uint32)).tolist()
            if (
                batch.size > 1
                and not self.inside
                and (different := [s.sensor for s in self.sensors.values() if self._each(s)])
            ):
                raise WorldError(
                    f"{', '.join(sorted(set(different)))} differ from copy to copy, and a batch of copies"
                    " cannot be run in this world",
                    fix="Run them one by one: dd.Trials(..., together=False), or an experiment",
                )
            with errors_of(self.world, "reset"):
                self.world.reset(seed, copies, precision)
        self.unread, self._commands = True, None
        self._last = 0
        self._due = self._origin = 0

    @property
    def live(self) -> bool:
        """Whether there is a world on the host with sensors or motors that the model uses."""
        return self.world is not None and not self.inside and bool(self.sensors or self.motors)

    def steps(self, tick: int, period: int) -> int:
        """Return the steps until the next exchange; `period` is in ticks, 0 if the world never changes."""
        if not self.live or not period:
            return NEVER
        if self.unread or tick < self._last or tick >= self._due:
            return period - (tick - self._origin) % period
        return self._due - tick

    def read(
        self,
        instant: ExchangeInstant,
        period: int,
        dt: float,
        dtype: DTypeLike,
        sensed: dict[str, np.ndarray],
    ) -> None:
        """Advance the world to the present, and write the sensors' values to `sensed` if they are due."""
        if self.world is None or not self.live:
            return
        back = instant.tick < self._last  # after the restore of a snapshot
        if not self.unread and not back and (not period or instant.tick < self._due):
            return
        requests = [(sensor.sensor, tuple(sensor.axes)) for sensor in self.sensors.values()]
        readings: Sequence[np.ndarray] | None = None
        if period and (back or instant.tick >= self._due):
            late = (instant.tick - self._origin) % period
            if not back and self._commands is not None:
                with errors_of(self.world, "act"):
                    if isinstance(self.world, PureWorld) and self.world.exchanges:
                        before = None if self.unread else self._readings
                        readings = self.world.exchange(self._commands, requests, before)
                    else:
                        self.world.act(
                            self._commands, (instant.time - (instant.tick - self._last) * dt) * instant.unit
                        )
            self._commands = None
            self._last, self._due = instant.tick - late, instant.tick - late + period
        self.unread = True  # after an error the next step reads them again
        if readings is None:
            with errors_of(self.world, "sense"):
                moment = (instant.time - (instant.tick - self._last) * dt) * instant.unit
                readings = self.world.sense_all(requests, moment)
        for (ident, sensor), reading in zip(self.sensors.items(), readings, strict=True):
            sensed[ident] = self._checked(sensor, reading, dtype)
        self.unread, self._readings = False, readings

    def read_motors(self, tick: int, period: int, read: MotorReader) -> None:
        """Read and store the commands of the motors; called before steps from the tick of an exchange."""
        if (
            self.world is None
            or not self.live
            or not period
            or tick != self._last
            or self._commands is not None
        ):
            return
        values = read(list(self.motors))
        commands: dict[str, np.ndarray] = {}
        for motor, command in zip(self.motors.values(), values, strict=True):
            if not np.isfinite(command).all():
                raise NotFinite(
                    f"the motor {motor.motor!r} received {show(command.ravel()[0])}",
                    [motor.name],
                    fix="Check the elements that drive it",
                )
            commands[motor.motor] = command.reshape(-1, *shape(tuple(motor.axes)))
        self._commands = commands

    def restep(self, tick: int, factor: float) -> None:
        """Adapt to a new step from this tick on; `factor` is the old step over the new one.

        The next exchange stays at its time, rounded up to a step.
        """
        self._last = tick - (tick - self._last) * factor
        self._due = self._origin = tick + math.ceil(max(0, self._due - tick) * factor - 1e-6)

    def keep(self) -> WorldState | None:
        """Return the present state, as an argument for `put`."""
        if self.world is None:
            return None
        with errors_of(self.world, "keep"):
            world_state = self.world.keep()
            moves = type(self.world).arrangement is not World.arrangement
            objects = self.world.arrangement() if moves else None
        times = self._last, self._due, self._origin
        return WorldState(type(self.world), world_state, *times, self._commands, objects)

    def put_now(self, arrays: Any) -> None:
        """Set the state of a world that was computed inside the step: all copies, with an axis of one row."""
        if self.world is not None:
            with errors_of(self.world, "put"):
                self.world.put(jax.tree.map(lambda a: a[:, 0], arrays))

    def put(self, world_state: WorldState | None) -> None:
        """Restore a state that `keep` returned; the sensors are read again."""
        self.unread = True
        if world_state is not None and self.world is not None and isinstance(self.world, world_state.kind):
            state = world_state.world
            if isinstance(state, StoredLeaves):
                name = f"the world {type(self.world).__name__}"
                with errors_of(self.world, "keep"):
                    structure = self.world.keep()
                    if len(jax.tree.leaves(structure)) != len(state.leaves):
                        structure = self.world.older_form(structure)
                state = stored.filled(structure, state.leaves, name)
            with errors_of(self.world, "put"):
                if world_state.objects is not None:
                    self.world.arrange(world_state.objects)
                self.world.put(state)
            self._last, self._due, self._origin = world_state.last, world_state.due, world_state.origin
            self._commands = world_state.commands

    def _each(self, sensor: Sensor) -> bool:
        signals = {} if self.world is None else self.world.sensors  # a user's world may accept any name
        return sensor.sensor in signals and signals[sensor.sensor].each

    def _checked(self, sensor: Sensor, numbers: object, dtype: DTypeLike) -> np.ndarray:
        """Return a reading for a single copy, if it has the shape of the sensor and is finite."""
        axes = tuple(sensor.axes)
        try:
            reading = np.asarray(numbers, dtype)
        except (TypeError, ValueError):  # not numbers
            reading = np.asarray(np.nan)
        if self._each(sensor) and reading.ndim:
            reading = reading[0]
        if reading.shape != tuple(a.samples for a in axes) or not np.isfinite(reading).all():
            kind = type(self.world)
            method = "read" if isinstance(self.world, PureWorld) else "sense"
            world = "the world" if registry.own(kind) else f"the world {position(kind, method)}"
            raise WorldError(
                f"{world} gave an array of shape {list(reading.shape)}, finite:"
                f" {bool(np.isfinite(reading).all())}; it needs {[a.samples for a in axes]}, finite",
                where=sensor.sensor,
            )
        return reading


def embodied(doc: Document, world: World | None) -> Body | None:
    """Return the `Body` that computes a world inside the step.

    Return None if the world does not consist of pure functions, or the model does not use it; it is then
    computed on the host.
    """
    if not isinstance(world, PureWorld) or not world.inside:
        return None
    sensors, motors = used(doc, world)
    if not sensors and not motors:
        return None
    steps = 0.0 if world.period is None else world.period / (unit_seconds(doc.time_unit) * 1e3) / doc.step
    return Body(world, sensors, motors, holds=steps > HELD)


def used(doc: Document, world: World | None) -> tuple[dict[str, Sensor], dict[str, Motor]]:
    """Return the sensors and motors of a document by id, each of which the world must have.

    Motors without a world have no effect.

    Raises:
        WorldError: the document has a sensor and there is no world; the world lacks a sensor or motor, or has
            it over other axes or in another unit; or two elements drive one motor.
    """
    if world is not None and not isinstance(world, World):
        raise WorldError(
            f"expected a world, got {show(world)}", fix="For a picture: world=dd.Picture('photo.jpg')"
        )
    sensors: dict[str, Sensor] = {}
    motors: dict[str, Motor] = {}
    driven: dict[str, str] = {}
    for e in doc.entries:
        if isinstance(e.element, Sensor):
            if world is None:
                raise WorldError(
                    f"reads the sensor {e.element.sensor!r}, and no world was given that provides it",
                    where=e.path,
                    fix=option("Give one:", "world", "picture:photo.jpg", "dd.Picture('photo.jpg')"),
                )
            world.require(e.element.sensor)
            _fit(e.path, e.element.sensor, world, world.sensors, tuple(e.element.axes))
            sensors[e.id] = e.element
        if isinstance(e.element, Motor):
            name = e.element.motor
            if name in driven:
                raise WorldError(
                    f"drives the motor {name!r}, which {driven[name]} drives",
                    where=e.path,
                    fix="Connect both to one Motor, which adds its inputs",
                )
            driven[name] = e.path
            if world is not None:
                world.require_motor(name)
                _fit(e.path, name, world, world.motors, tuple(e.element.axes))
                motors[e.id] = e.element
    wrong = [p for p in agreement.judge(doc, world) if p.severity == "problem"]
    if wrong:
        raise WorldError(wrong)
    return sensors, motors


def _fit(path: str, name: str, world: World, signals: Mapping[str, Signal], axes: Axes) -> None:
    try:
        if name in signals:  # a user's world may accept any name
            fitting(name, signals[name], axes)
    except WorldError as error:
        fix = world.alternative(name, shape(axes)) or "Give the element such axes, or choose another world"
        raise WorldError(error.problems[0].what, where=path, fix=fix) from None
