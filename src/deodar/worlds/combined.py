"""A world with sensors of other worlds."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np

from deodar import codec, registry
from deodar.codec import Json, JsonObject
from deodar.credentials import masked
from deodar.errors import Problem, WorldError
from deodar.numerics.axes import Axes
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of
from deodar.worlds._naming import named_kind
from deodar.worlds._outer import OuterWorld
from deodar.worlds.arena.arena import Arena
from deodar.worlds.picture import Picture


@register
class Combined(OuterWorld):
    r"""A world, some of whose sensors are read from other worlds, such as a camera above a simulated table.

    A model and its parameters stay the same when a real camera or a video takes the place of a simulated one.
    Everything else is that of the first world: its motors, objects, and the times of the exchange.

    Equation:
        y_s(t) = y^{(s)}(t) \text{ for a sensor } s \text{ of another world, else } y(t)

    Parameters:
        world: the world that has the motors.
        sensors: for each sensor the world that it is read from: its sensor of the same name, or its only one.
            These worlds have no motors.

    Shapes:
        Those of the worlds that the sensors are read from.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5 (a simulated and a real
        robot, a camera and a recorded picture in one architecture).
    """

    stands_in = False
    # of the example
    sensors: Mapping[str, Signal] = {**Arena.sensors, "camera": Picture.sensors["picture"]}
    motors: Mapping[str, Signal] = Arena.motors

    def __init__(self, world: World, sensors: Mapping[str, World]) -> None:
        self.world, self.others = world, dict(sensors)
        if not self.others:
            raise WorldError("no sensor is read from another world", fix='For example {"camera": Camera(0)}')
        self._names = {name: _read(name, other) for name, other in self.others.items()}
        self.period, self.motors = world.period, world.motors
        taken = {name: self._signal(name) for name in self.others}
        self.sensors = {**world.sensors, **taken}

    def _signal(self, name: str) -> Signal:
        other = self.others[name]
        signal = other.sensors[self._names[name]]
        period = other.period if signal.period is None else signal.period
        step = self.period
        # a picture is new at an exchange only
        fits = step is not None and period is not None and period % step == 0
        return replace(signal, period=period if fits else None)

    @property
    def repeatable(self) -> bool:  # type: ignore[override]
        """Whether a restored state leads to the same readings again."""
        return all(one.repeatable for one in (self.world, *self.others.values()))

    @property
    def wall_clock(self) -> bool:  # type: ignore[override]
        """Whether it follows the wall clock."""
        return any(one.wall_clock for one in (self.world, *self.others.values()))

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        for one in (self.world, *self.others.values()):
            with errors_of(one, "reset"):
                one.reset(seed, trials, precision)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        other = self.others.get(sensor)
        with errors_of(other or self.world, "sense"):
            return (
                self.world.sense(sensor, axes, time)
                if other is None
                else other.sense(self._names[sensor], axes, time)
            )

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        with errors_of(self.world, "act"):
            self.world.act(motors, time)

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        other = self.others.get(sensor)
        if other is None:
            yield from self.world.validate_axes(sensor, axes)
        else:
            yield from other.validate_axes(self._names[sensor], axes)

    def validate(self) -> Iterator[Problem]:
        for one in (self.world, *self.others.values()):
            yield from one.validate()

    def close(self) -> None:
        """Release the cameras and files of all worlds."""
        for one in (self.world, *self.others.values()):
            close = getattr(one, "close", None)
            if callable(close):
                close()

    # ------------------------------------------------------------------------- everything of the first world

    def halt(self) -> None:
        self.world.halt()

    def alternative(self, signal: str, shape: Sequence[int]) -> str:
        return "" if signal in self.others else self.world.alternative(signal, shape)

    # -------------------------------------------------------------------------------------- state and records

    def keep(self) -> Any:
        kept = {name: other.keep() for name, other in self.others.items()}
        return {"world": self.world.keep(), "sensors": kept}

    def put(self, kept: Any) -> None:
        self.world.put(kept["world"])
        for name, other in self.others.items():
            other.put(kept["sensors"][name])

    def describe(self) -> dict[str, Json]:
        sensors: JsonObject = {name: other.describe() for name, other in self.others.items()}
        said: JsonObject = {"world": "Combined", "of": self.world.describe(), "sensors": sensors}
        text = codec.line(said, ascii=True, sort=True)
        return {**said, "sha256": hashlib.sha256(text.encode()).hexdigest()}

    @classmethod
    def open(cls, argument: str) -> Combined:
        """Make a combined world from texts such as `mujoco:table;camera=video:table.mp4`."""
        first, *pieces = (piece.strip() for piece in argument.split(";"))
        body = _named(first)
        sensors: dict[str, World] = {}
        for piece in pieces:
            name, equal, text = (part.strip() for part in piece.partition("="))
            if not equal or not name or "://" in name:
                raise WorldError(
                    f"{show(masked(piece))} names no sensor", fix="Write camera=video:table.mp4, say"
                )
            sensors[name] = _named(text)
        return cls(body, sensors)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Combined:
        sensors = cast("Mapping[str, Any]", described["sensors"])
        return cls(_again(described["of"]), {name: _again(other) for name, other in sensors.items()})

    @classmethod
    def example(cls) -> Combined:
        """Return the example of an arena, whose robot sees the example of a picture."""
        return cls(Arena.example(), {"camera": Picture.example()})

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return Picture.example_axes("picture") if sensor == "camera" else Arena.example_axes(sensor)


def _read(name: str, other: World) -> str:
    """Return the sensor of another world that is read."""
    kind = type(other).__name__
    if other.motors:
        raise WorldError(f"the world {kind} has motors, which nothing would move", where=name)
    if name in other.sensors:
        return name
    if len(other.sensors) != 1:
        known = ", ".join(sorted(other.sensors)) or "none"
        raise WorldError(f"the world {kind} has no sensor {name!r}, and not one alone: {known}", where=name)
    return next(iter(other.sensors))


def _named(text: str) -> World:
    kind, argument = named_kind(text, text)
    with errors_of(kind, "open", argument):
        return kind.open(argument)


def _again(described: Any) -> World:
    kind = registry.kinds("worlds")[str(described["world"])]
    with errors_of(kind, "again"):
        return kind.again(described)
