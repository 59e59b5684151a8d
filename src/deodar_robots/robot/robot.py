"""A robot that a file describes, as a world."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from deodar import codec, registry, regular_file
from deodar.codec import Json, JsonObject
from deodar.credentials import masked, masked_data
from deodar.errors import Problem, WorldError, did_you_mean
from deodar.numerics.axes import Axes
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._address import is_address
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of
from deodar.worlds._outer import OuterWorld
from deodar.worlds._settings import arguments
from deodar.worlds._settings import settings as declared
from deodar.worlds.arena.arena import Arena
from deodar_robots.limited_world import LimitedWorld
from deodar_robots.motor_limiter import MotorLimiter, slowed
from deodar_robots.robot import robot_file
from deodar_robots.robot.robot_file import RobotFile, RobotMotor, RobotSensor

NOT_DATA = ("combined", "recording", "robot")
"""Kinds of worlds whose arguments are not plain data."""

ENDPOINTS = ("at", "topic", "type")
"""Settings that contain slashes and are not paths."""

SOURCES = ("source",)
"""Settings that name a path, an address of a camera, or a device."""

_DEVICE = re.compile(r"/dev/video\d+")


@register
class Robot(LimitedWorld, OuterWorld):
    r"""A robot that a file describes: which world it is, how its signals are called, and what its motors
    allow.

    The same model moves another robot when another file is named, or another place of the file, for example
    the simulated robot and the one of the laboratory. Commands are kept within the limits and the rate of
    change of each motor, before they leave the process.

    Equation:
        y(t) = a\, y_{\mathrm{world}}(t) + b,\quad
        m_{\mathrm{world}} = \alpha\, \mathrm{limited}(m) + \beta

    Parameters:
        file: path of the file, or the name of a robot that comes with deodar (arm, epuck, head).
        place: name of a place of the file; empty: the first one.

    Shapes:
        Those of the world.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 3.3 (robots of one
        architecture exchanged by their configuration).
    """

    # of the example
    sensors: Mapping[str, Signal] = Arena.sensors
    motors: Mapping[str, Signal] = Arena.motors
    stands_in = False

    def __init__(self, file: str | Path, place: str = "") -> None:
        self.path = robot_file.found(str(file))
        self.source, self.place_name = str(file), place
        self.file = robot_file.load_robot(self.path).at(place)
        self.world = _world(self.file, self.path)
        self.period = self.world.period
        where = str(self.path)
        if self.file.period is not None and self.file.period != self.period:
            raise WorldError(
                f"states a period of {self.file.period:g} ms; its world has {self.period}", where
            )
        given = self.file.sensors or {name: RobotSensor() for name in self.world.sensors}
        self._sensors = {name: (entry.source or name, entry) for name, entry in given.items()}
        moved = self.file.motors or {name: RobotMotor() for name in self.world.motors}
        self._motors = {name: (entry.target or name, entry) for name, entry in moved.items()}
        self.sensors = {
            name: _signal(name, self.world.sensors, source, entry, f"{where}: sensor {name}")
            for name, (source, entry) in self._sensors.items()
        }
        self.motors = {
            name: _signal(name, self.world.motors, target, entry, f"{where}: motor {name}")
            for name, (target, entry) in self._motors.items()
        }
        own = {} if self.file.motors else self.world.rules
        rules = self._declare_rules(
            {n: own.get(n) or entry.rule(f"{where}: {n}") for n, (_, entry) in self._motors.items()}
        )
        self._limiter = MotorLimiter(self.motors, rules)

    # ------------------------------------------------------------------------------------------- the exchange

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._limiter.begin(len(trials))
        with errors_of(self.world, "reset"):
            self.world.reset(seed, trials, precision)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self.sense_all([(sensor, axes)], time)[0]

    def sense_all(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        for sensor, _ in requests:
            self.require(sensor)
        inner = [(self._sensors[sensor][0], axes) for sensor, axes in requests]
        with errors_of(self.world, "sense"):
            readings = self.world.sense_all(inner, time)
        return [
            _scaled(reading, self._sensors[sensor][1])
            for (sensor, _), reading in zip(requests, readings, strict=True)
        ]

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        commands: dict[str, np.ndarray] = {}
        for name, command in motors.items():
            self.require_motor(name)
            target, entry = self._motors[name]
            commands[target] = _scaled(self._limiter.allowed(name, command, self.period or 0.0), entry)
        with errors_of(self.world, "act"):
            self.world.act(commands, time)

    def halt(self) -> None:
        self._limiter.rest()
        self.world.halt()

    def source_of(self, sensor: str) -> str:
        """Return the name of a sensor in the world."""
        return self._sensors[sensor][0]

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        return self.world.validate_axes(self._sensors[sensor][0], axes)

    def alternative(self, signal: str, shape: Sequence[int]) -> str:
        name, _ = {**self._sensors, **self._motors}[signal]
        return self.world.alternative(name, shape)

    # -------------------------------------------------------------------------------------- state and records

    def keep(self) -> Any:
        return {"world": self.world.keep(), "commands": self._limiter.keep()}

    def older_form(self, state: Any) -> Any:
        commands = slowed(state["commands"], self._robot_rules)
        return {"world": self.world.older_form(state["world"]), "commands": commands}

    def put(self, kept: Any) -> None:
        if kept is None:
            return
        self.world.put(kept["world"])
        self._limiter.put(kept["commands"])

    def describe(self) -> dict[str, Json]:
        said: JsonObject = {
            "world": "Robot",
            "robot": self.file.name,
            "file": self.source,
            "place": self.place_name,
            "settings": masked_data(codec.parse(codec.line(msgspec.to_builtins(self.file)))),
            "of": self.world.describe(),
            **self._narrowing(),
        }
        text = codec.line(said, ascii=True, sort=True)
        return {**said, "sha256": hashlib.sha256(text.encode()).hexdigest()}

    @classmethod
    def open(cls, argument: str) -> Robot:
        """Make the robot of a text such as `epuck.json@lab`; without a place it is at the first one."""
        file, _, place = argument.strip().rpartition("@") if "@" in argument else (argument.strip(), "", "")
        return cls(file, place)

    @classmethod
    def names(cls) -> list[str]:
        return list(robot_file.shipped())

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Robot:
        robot = cls(str(described["file"]), str(described["place"]))
        robot._narrow_as(described)
        return robot

    @classmethod
    def example(cls) -> Robot:
        """Return the e-puck that comes with deodar, in its arena."""
        return cls("epuck")

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return Arena.example_axes(sensor)


def _world(file: RobotFile, path: Path) -> World:
    """Return the world of a robot."""
    kinds = {
        name.casefold(): kind
        for name, kind in registry.kinds("worlds").items()
        if name.casefold() not in NOT_DATA
    }
    kind = kinds.get(file.kind.casefold().replace("-", ""))
    if kind is None:
        fix = did_you_mean(file.kind.casefold(), kinds)
        raise WorldError(f"there is no kind {file.kind!r} of robots", where=str(path), fix=fix)
    known = declared(kind)
    strange = next((name for name in file.settings if name not in known), None)
    if strange is not None:
        fix = did_you_mean(strange, known)
        raise WorldError(f"the kind {file.kind} has no setting {strange!r}", where=str(path), fix=fix)
    settings = {name: _inside(name, value, path) for name, value in file.settings.items()}
    if file.period is not None and "period" in known:
        settings.setdefault("period", file.period)
    try:
        with errors_of(kind, "open"):
            return kind(**arguments(kind, settings))
    except TypeError as error:  # a value of another type than the setting
        raise WorldError(f"its settings do not fit the kind {file.kind}: {error}", str(path)) from None


def _inside(name: str, value: Any, path: Path) -> Any:
    """Return a setting, with a file as a path; it has to lie in the folder of the robot's file."""
    if isinstance(value, list):
        return [_inside(name, each, path) for each in value]
    if isinstance(value, dict):
        return {key: _inside(str(key), each, path) for key, each in value.items()}
    if not isinstance(value, str) or name in ENDPOINTS:
        return value
    if name in SOURCES and (is_address(value) or _DEVICE.fullmatch(str(Path(value).resolve()))):
        return value
    folder = path.resolve().parent
    named = folder / value
    # a folder with a bag is opened as one file
    names_file = any(regular_file.is_file(file) for file in (named, named / "metadata.yaml"))
    if names_file or any(mark in value for mark in ("/", "\\", "..")):
        if not named.resolve().is_relative_to(folder):
            raise WorldError(
                f"{name} is {show(masked(value))}, outside the folder of the robot's file", where=str(path)
            )
        return str(named)
    return value


def _signal(
    name: str, known: Mapping[str, Signal], source: str, entry: RobotSensor | RobotMotor, where: str
) -> Signal:
    """Return the signal of the world under the name and in the unit of the file."""
    if source not in known:
        raise WorldError(
            f"its world has no {source!r}", where=where, fix=did_you_mean(source, known) or "It has none"
        )
    signal = known[source]
    shape = signal.shape if entry.shape is None else tuple(entry.shape)
    if signal.shape is not None and shape != signal.shape:
        raise WorldError(f"has the shape {list(shape or ())}; its world has {list(signal.shape)}", where)
    changed = entry.scale != 1 or entry.offset != 0
    if entry.unit and signal.unit and entry.unit != signal.unit and not changed:
        raise WorldError(
            f"is in {entry.unit}; its world has it in {signal.unit}", where=where, fix="State its scale"
        )
    bounds = signal.bounds
    if bounds is not None and changed:
        ends = [sorted(entry.scale * end + entry.offset for end in pair) for pair in bounds]
        bounds = tuple((low, high) for low, high in ends)
    meaning, unit = entry.meaning or signal.meaning, entry.unit or signal.unit
    return replace(signal, meaning=meaning, shape=shape, unit=unit, bounds=bounds)


def _scaled(values: np.ndarray, entry: RobotSensor | RobotMotor) -> np.ndarray:
    if entry.scale == 1 and entry.offset == 0:
        return values
    array = np.asarray(values)
    wide = array if array.dtype.kind == "f" else array.astype(np.float32)
    return (entry.scale * wide + entry.offset).astype(wide.dtype)
