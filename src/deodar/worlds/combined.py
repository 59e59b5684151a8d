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
        self._names = {name: _read(name, origin) for name, origin in self.others.items()}
        self.period, self.motors = world.period, world.motors
        taken = {name: self._signal(name) for name in self.others}
        self.sensors = {**world.sensors, **taken}

    def _signal(self, name: str) -> Signal:
        origin = self.others[name]
        signal = origin.sensors[self._names[name]]
        period = origin.period if signal.period is None else signal.period
        step = self.period
        # a picture is new at an exchange only
        fits = step is not None and period is not None and period % step == 0
        return replace(signal, period=period if fits else None)

    @property
    def members(self) -> tuple[World, ...]:
        return (self.world, *self.others.values())

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        for member in self.members:
            with errors_of(member, "reset"):
                member.reset(seed, trials, precision)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        origin = self.others.get(sensor)
        with errors_of(origin or self.world, "sense"):
            return (
                self.world.sense(sensor, axes, time)
                if origin is None
                else origin.sense(self._names[sensor], axes, time)
            )

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        with errors_of(self.world, "act"):
            self.world.act(motors, time)

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        origin = self.others.get(sensor)
        if origin is None:
            yield from self.world.validate_axes(sensor, axes)
        else:
            yield from origin.validate_axes(self._names[sensor], axes)

    def alternative(self, signal: str, shape: Sequence[int]) -> str:
        return "" if signal in self.others else self.world.alternative(signal, shape)

    # -------------------------------------------------------------------------------------- state and records

    def keep(self) -> Any:
        states = {name: origin.keep() for name, origin in self.others.items()}
        return {"world": self.world.keep(), "sensors": states}

    def older_form(self, state: Any) -> Any:
        return {**state, "world": self.world.older_form(state["world"])}

    def put(self, kept: Any) -> None:
        self.world.put(kept["world"])
        for name, origin in self.others.items():
            origin.put(kept["sensors"][name])

    def describe(self) -> dict[str, Json]:
        sensors: JsonObject = {name: origin.describe() for name, origin in self.others.items()}
        description: JsonObject = {"world": "Combined", "of": self.world.describe(), "sensors": sensors}
        text = codec.line(description, ascii=True, sort=True)
        return {**description, "sha256": hashlib.sha256(text.encode()).hexdigest()}

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
        return cls(_again(described["of"]), {name: _again(origin) for name, origin in sensors.items()})

    @classmethod
    def example(cls) -> Combined:
        """Return the example of an arena, whose robot sees the example of a picture."""
        return cls(Arena.example(), {"camera": Picture.example()})

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return Picture.example_axes("picture") if sensor == "camera" else Arena.example_axes(sensor)


def _read(name: str, origin: World) -> str:
    """Return the sensor of another world that is read."""
    kind = type(origin).__name__
    if origin.motors:
        raise WorldError(f"the world {kind} has motors, which nothing would move", where=name)
    if name in origin.sensors:
        return name
    if len(origin.sensors) != 1:
        names = ", ".join(sorted(origin.sensors)) or "none"
        raise WorldError(f"the world {kind} has no sensor {name!r}, and not one alone: {names}", where=name)
    return next(iter(origin.sensors))


def _named(text: str) -> World:
    kind, argument = named_kind(text, text)
    with errors_of(kind, "open", argument):
        return kind.open(argument)


def _again(described: Any) -> World:
    kind = registry.kinds("worlds")[str(described["world"])]
    with errors_of(kind, "again"):
        return kind.again(described)
