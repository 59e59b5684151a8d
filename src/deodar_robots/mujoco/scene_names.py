"""Names of the sensors and motors of a compiled scene; each has one, and no two have the same.

MJCF leaves names to the author of a file, who often states none for actuators and sensors.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from deodar_robots.mujoco.scene_file import simulator


@dataclass(frozen=True)
class SceneNames:
    """Numbers of the objects of a compiled scene by their names in the world, in the order of the file.

    A camera without a name is `camera` with its number. An actuator without one has that of the joint,
    tendon, site or body that it moves; a sensor that of what it measures and its type (`tip_gyro`), or its
    type alone (`clock`). A mocap body, whose position and orientation nothing but a command changes, has two
    motors. What would have the name of another gets a number, `hip_2`; names in the file come first.

    Attributes:
        cameras: number of each camera.
        sensors: number of each sensor of the file.
        actuators: number of each actuator.
        positions: mocap number of each motor that is the position of a mocap body.
        orientations: mocap number of each motor that is the orientation of a mocap body.
    """

    cameras: dict[str, int]
    sensors: dict[str, int]
    actuators: dict[str, int]
    positions: dict[str, int]
    orientations: dict[str, int]

    @classmethod
    def of(cls, model: Any, sensors: Iterable[str], motors: Iterable[str]) -> SceneNames:
        """Return the names of a scene.

        Args:
            model: the compiled scene.
            sensors: names of readings that the world has besides those of the file.
            motors: names of such motors.
        """
        reading_names, motor_names = _UniqueNames(sensors), _UniqueNames(motors)
        cameras = [_Named(model.camera(k).name, f"camera{k}") for k in range(model.ncam)]
        measured = [_Named(model.sensor(k).name, _measured(model, k)) for k in range(model.nsensor)]
        moved = [_Named(model.actuator(k).name, _moved(model, k)) for k in range(model.nactuator)]
        bodies = sorted((int(m), k) for k, m in enumerate(model.body_mocapid) if m >= 0)
        reading_numbers = reading_names.numbers([*cameras, *measured])
        mocap = [_Named(model.body(k).name, "") for _, k in bodies]
        turned = [_Named("", f"{model.body(k).name}_orientation") for _, k in bodies]
        motor_numbers = motor_names.numbers([*moved, *mocap, *turned])
        return cls(
            *_parts(reading_numbers, len(cameras), len(measured)),
            *_parts(motor_numbers, len(moved), len(mocap), len(turned)),
        )


@dataclass(frozen=True)
class _Named:
    """An object with its name in the file, "" for none, and the name that it gets without one."""

    name: str
    otherwise: str


class _UniqueNames:
    """Names that are used."""

    def __init__(self, used: Iterable[str]) -> None:
        self._used = set(used)

    def numbers(self, objects: list[_Named]) -> list[str]:
        """Return a name of its own for each object, those of the file first."""
        chosen: dict[int, str] = {}
        for number in sorted(range(len(objects)), key=lambda k: not objects[k].name):
            name = objects[number].name or objects[number].otherwise
            chosen[number] = self._unused(name)
            self._used.add(chosen[number])
        return [chosen[number] for number in range(len(objects))]

    def _unused(self, name: str) -> str:
        numbered = (f"{name}_{k}" for k in itertools.count(2))
        return next(each for each in itertools.chain([name], numbered) if each not in self._used)


def _parts(names: list[str], *counts: int) -> Iterator[dict[str, int]]:
    """Yield the numbers of consecutive kinds of objects by their names."""
    left = iter(names)
    for count in counts:
        yield {name: number for number, name in enumerate(itertools.islice(left, count))}


def _moved(model: Any, actuator: int) -> str:
    """Return the name of what an actuator moves, else `actuator` with its number."""
    mujoco = simulator()
    ways, kinds = mujoco.mjtTrn, mujoco.mjtObj
    kind = {
        int(ways.mjTRN_SLIDERCRANK): kinds.mjOBJ_SITE,
        int(ways.mjTRN_TENDON): kinds.mjOBJ_TENDON,
        int(ways.mjTRN_SITE): kinds.mjOBJ_SITE,
        int(ways.mjTRN_BODY): kinds.mjOBJ_BODY,
    }.get(int(model.actuator_trntype[actuator]), kinds.mjOBJ_JOINT)
    name = mujoco.mj_id2name(model, kind, int(model.actuator_trnid[actuator, 0]))
    return name or f"actuator{actuator}"


def _measured(model: Any, sensor: int) -> str:
    """Return the name of what a sensor measures and the type of the sensor, as its element is called."""
    mujoco = simulator()
    form = mujoco.mjtSensor(int(model.sensor_type[sensor])).name.removeprefix("mjSENS_").lower()
    kind, number = int(model.sensor_objtype[sensor]), int(model.sensor_objid[sensor])
    name = mujoco.mj_id2name(model, kind, number) if number >= 0 else None
    return f"{name}_{form}" if name else form
