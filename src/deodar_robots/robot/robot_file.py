"""The file of a robot: which world it is, its signals, and what its motors allow."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from deodar import codec, file_version, regular_file
from deodar.errors import DeodarError, WorldError, did_you_mean, reading
from deodar.worlds._motor_rule import STOPS_AFTER, MotorRule

MOST_BYTES = 2**20
"""Largest file of a robot in bytes; the shipped ones have a thousandth of it."""

VERSION = 1
Positive = Annotated[float, Meta(gt=0)]
SignalShape = Annotated[list[Annotated[int, Meta(gt=0, le=10**6)]], Meta(max_length=8)]


class RobotSensor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A sensor of a robot. A reading is scale times the reading of the world plus offset."""

    meaning: Annotated[str, Meta(description="what it reads; by default what the world says")] = ""
    shape: Annotated[
        SignalShape | None,
        Meta(description="samples along each axis, as in the world; null: what the world has"),
    ] = None
    unit: Annotated[str, Meta(description="unit of the readings; by default that of the world")] = ""
    source: Annotated[str, Meta(description="name of the sensor in the world; by default the same")] = (
        msgspec.field(default="", name="from")
    )
    scale: Annotated[float, Meta(description="factor on the reading of the world")] = 1.0
    offset: Annotated[float, Meta(description="added to the scaled reading, in `unit`")] = 0.0


class RobotMotor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A motor of a robot. The world receives scale times the command plus offset."""

    meaning: Annotated[str, Meta(description="what it moves; by default what the world says")] = ""
    shape: Annotated[
        SignalShape | None,
        Meta(description="samples along each axis, as in the world; null: what the world has"),
    ] = None
    unit: Annotated[str, Meta(description="unit of the commands; by default that of the world")] = ""
    target: Annotated[str, Meta(description="name of the motor in the world; by default the same")] = (
        msgspec.field(default="", name="to")
    )
    scale: Annotated[float, Meta(description="factor on the command")] = 1.0
    offset: Annotated[float, Meta(description="added to the scaled command, in the unit of the world")] = 0.0
    limits: Annotated[
        tuple[float, float] | None, Meta(description="smallest and largest command of each sample, in `unit`")
    ] = None
    slew: Annotated[
        Positive | None, Meta(description="largest change of each sample, in `unit` per second")
    ] = None
    rest: Annotated[float, Meta(description="command at rest, in `unit`")] = 0.0
    stops_after: Annotated[
        Positive, Meta(description="time without a command after which the motor goes to rest, ms")
    ] = STOPS_AFTER

    def rule(self, where: str) -> MotorRule:
        """Return what the motor allows.

        Raises:
            WorldError: the limits are not in order, or the command at rest is outside of them.
        """
        values = {"slew": self.slew, "rest": self.rest, "stops_after": self.stops_after}
        return MotorRule.from_data({**values, "limits": self.limits}, where)


class RobotPlace(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What differs at a place. Sensors and motors replace those of the same name."""

    kind: Annotated[str, Meta(description="kind of the world; the settings above then do not count")] = ""
    settings: Annotated[dict[str, Any], Meta(description="settings that differ, or are new")] = {}
    period: Annotated[Positive | None, Meta(description="ms between two exchanges")] = None
    sensors: Annotated[dict[str, RobotSensor], Meta(description="sensors that differ, or are new")] = {}
    motors: Annotated[dict[str, RobotMotor], Meta(description="motors that differ, or are new")] = {}


class RobotFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The file of a robot."""

    robot: Annotated[int, Meta(ge=VERSION, le=VERSION, description="version of this form of file")]
    name: Annotated[str, Meta(min_length=1, max_length=100, description="name of the robot")]
    kind: Annotated[
        str, Meta(min_length=1, description="kind of the world, for example arena, mujoco, zenoh or ros2")
    ]
    settings: Annotated[
        dict[str, Any], Meta(description="settings of the world; files are named relative to this file")
    ] = {}
    period: Annotated[
        Positive | None, Meta(description="ms between two exchanges; by default that of the world")
    ] = None
    clock: Annotated[
        Literal["step", "live"] | None,
        Meta(description="clock with which `deodar serve` serves it; by default that of its world"),
    ] = None
    sensors: Annotated[
        dict[str, RobotSensor], Meta(description="sensors by name; without any, those of the world")
    ] = {}
    motors: Annotated[
        dict[str, RobotMotor], Meta(description="motors by name; without any, those of the world")
    ] = {}
    places: Annotated[
        dict[str, RobotPlace], Meta(description="what differs at a place; the first is the default")
    ] = {}

    def at(self, place: str) -> RobotFile:
        """Return the file as it is at a place; empty: at the first one.

        Raises:
            WorldError: the file has no such place.
        """
        if not self.places and not place:
            return self
        name = place or next(iter(self.places))
        if name not in self.places:
            fix = did_you_mean(name, self.places) or "The file has no places"
            raise WorldError(f"the robot {self.name!r} has no place {name!r}", fix=fix)
        here = self.places[name]
        kept = {} if here.kind else self.settings
        return msgspec.structs.replace(
            self,
            kind=here.kind or self.kind,
            settings={**kept, **here.settings},
            period=here.period if here.period is not None else self.period,
            sensors={**self.sensors, **here.sensors},
            motors={**self.motors, **here.motors},
            places={},
        )


def shipped() -> dict[str, Path]:
    """Return the files of the robots that come with deodar, by name."""
    folder = Path(str(resources.files("deodar_robots.robot") / "robots"))
    return {file.stem: file for file in sorted(folder.glob("*.json"))}


def found(text: str) -> Path:
    """Return the file that a text names: a path, a file in the folder `robots`, or a shipped robot.

    Raises:
        WorldError: there is no such file.
    """
    path, known = Path(text), shipped()
    for candidate in (path, Path("robots", text), Path("robots", f"{text}.json")):
        if regular_file.is_file(candidate):
            return candidate
    stem = text.removesuffix(".json")
    if stem in known:
        return known[stem]
    raise WorldError(f"there is no robot file {text!r}", fix=did_you_mean(stem, known))


def load_robot(path: Path) -> RobotFile:
    """Read the file of a robot.

    Raises:
        WorldError: the file is not one, or is too large.
    """
    try:
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise WorldError(f"has {size} bytes; the file of a robot has at most {MOST_BYTES}", str(path))
        data = codec.read(regular_file.read_bytes(path), codec.FEW_VALUES)
    except OSError as error:
        raise WorldError(f"cannot be read: {error.strerror or error}", where=str(path)) from None
    except WorldError:
        raise
    except DeodarError as error:
        raise WorldError(error.problems[0].what, where=str(path)) from None
    if isinstance(data, dict) and isinstance(data.get("robot"), int):
        with reading(path, WorldError):
            file_version.require_readable("a robot file", data["robot"], VERSION, data, WorldError)
    try:
        file = msgspec.convert(data, RobotFile)
    except msgspec.ValidationError as error:
        fix = "Its form is in worlds/robot/robot.schema.json"
        raise WorldError(f"is not the file of a robot: {error}", where=str(path), fix=fix) from None
    for place in ("", *file.places):
        for name, motor in file.at(place).motors.items():
            motor.rule(f"{path}: {f'{place} ' if place else ''}{name}")
    return file


def robot_schema() -> dict[str, Any]:
    """Return the JSON Schema of the file of a robot."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(RobotFile)}
