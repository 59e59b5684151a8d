"""The contract of a world: an environment with named sensors and motors, updated at its own rate.

A model refers to sensors and motors by name; a world provides them.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from deodar.codec import Json
from deodar.errors import Problem, WorldError, did_you_mean
from deodar.numerics.axes import Axes, shape
from deodar.worlds._link_state import LinkState
from deodar.worlds._motor_rule import MotorRule
from deodar.worlds._scene import Scene


@dataclass(frozen=True)
class Signal:
    """Description of a sensor or a motor of a world.

    Attributes:
        meaning: a phrase that says what the sensor reads or the motor moves.
        shape: samples along each axis; None: the world samples the sensor over any axes that the model
            states.
        unit: unit of the values; "" if they have none.
        period: ms between two new values; None: the period of the world.
        each: True if each copy of a model has its own signal (its own robot), False if all copies share one
            (one camera).
        bounds: smallest and largest value of each sample without noise, where they are known.
    """

    meaning: str
    shape: tuple[int, ...] | None = None
    unit: str = ""
    period: float | None = None
    each: bool = False
    bounds: tuple[tuple[float, float], ...] | None = None

    def __str__(self) -> str:
        samples = (
            "" if self.shape is None else " x ".join(map(str, self.shape)) if self.shape else "one number"
        )
        new = "" if self.period is None else f"a new value every {self.period:g} ms"
        return "; ".join(part for part in (self.meaning, f"{samples} {self.unit}".strip(), new) if part)


class World:
    """Base class of worlds: computed on the host, constant between two exchanges with the model.

    At each multiple t of the period, the model receives the readings of the sensors and the world receives
    the values of the motors, whose effect on the sensors appears at t + period. A world with dynamics of its
    own advances in `act`, or as a function of the time argument of `sense`.

    Several copies of a model (trials, points of a sweep) run at once, each with its own robot. Motor values
    have a leading axis of copies, and so have readings of sensors whose signal has `each`; other readings
    have no such axis and are the same for all copies.

    Class attributes:
        sensors: signals of the sensors by name.
        motors: signals of the motors by name.
        rules: what motors allow, by name; one without a rule allows any command.
        stands_in: whether the example of this class may be used when the user chose no world; False if the
            class needs an extra or a device.
        repeatable: whether a restored state leads to the same readings again; False if they come from
            outside, as those of a camera.
        wall_clock: whether it follows the wall clock whatever the model does, so that a run has to be paced.
        opens: endings of the files that `open` reads, in lower case with the dot, such as .png, the formats
            of this class before those that others open too; empty if its argument does not name a file.
        short: another name of the class on the command line; empty: there is none.

    Attributes:
        period: ms between two exchanges; None: the world never changes, and a run reads each sensor once.
    """

    sensors: Mapping[str, Signal] = {}
    motors: Mapping[str, Signal] = {}
    rules: Mapping[str, MotorRule] = {}
    period: float | None = None
    stands_in: ClassVar[bool] = True
    repeatable: ClassVar[bool] = True
    wall_clock: ClassVar[bool] = False
    opens: ClassVar[tuple[str, ...]] = ()
    short: ClassVar[str] = ""

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        """Return the world to its initial state.

        Args:
            seed: seed of all noise.
            trials: trial number of each copy; copies of one trial have the same noise.
            precision: precision of the model, float32 or float64; a simulated world uses the same precision.
        """

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        """Return the reading of a sensor at `time` (ms), sampled over `axes`.

        Values are finite. The array has the shape of the axes, after a leading axis of copies if the signal
        has `each`.
        """
        raise NotImplementedError

    def sense_all(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        """Return the readings of several sensors, each with its axes, at `time` (ms).

        They equal those of `sense`; a world overrides it where reading them together costs less.
        """
        return [self.sense(sensor, axes, time) for sensor, axes in requests]

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        """Advance by one period from `time` (ms) with constant motor values.

        Args:
            motors: for each driven motor an array with copies first.
            time: start of the period, ms.
        """

    def keep(self) -> Any:
        """Return the present state, as an argument for `put`."""
        return None

    def put(self, kept: Any) -> None:
        """Restore a state that `keep` returned."""

    def older_form(self, state: Any) -> Any:
        """Return a state that `keep` returned in the form that it had in older versions, whose files `put`
        restores, too; by default the form is the same.
        """
        return state

    def scene(self) -> Scene | None:
        """Return the present view from above; None if the world has none."""
        return None

    def halt(self) -> None:
        """Put the motors to rest at once, until the next commands; called when a run pauses or fails.

        Nothing by default: a simulated world does not move while its model pauses.
        """

    def close(self) -> None:
        """Release devices, files and connections; nothing by default."""

    def link(self) -> LinkState | None:
        """Return how well the link with the robot works; None if the world is not in another process."""
        return None

    def narrow(
        self, motor: str, limits: tuple[float, float] | None = None, slew: float | None = None
    ) -> None:
        """Narrow what a motor allows, from the next command on; nothing widens it again.

        Args:
            motor: name of the motor.
            limits: smallest and largest value of each sample; None: as before.
            slew: largest change of each sample, in the unit of the motor per second; None: as before.
        """
        raise WorldError(f"the world {type(self).__name__} cannot narrow what its motors allow", where=motor)

    @property
    def can_narrow(self) -> bool:
        """Whether `narrow` narrows what motors allow."""
        return type(self).narrow is not World.narrow

    def preview(self) -> np.ndarray | None:
        """Return a picture (height, width, 3), values 0 to 1, by which a user recognises the world.

        None: the scene, or the reading of the first sensor without a shape, is such a picture.
        """
        return None

    def move(self, name: str, center: Sequence[float]) -> None:
        """Move an object or a mark of the scene; `center` is the new x and y of its middle."""
        raise WorldError(f"nothing in the world {type(self).__name__} can be moved", where=name)

    def place(
        self,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Sequence[float] = (0.72, 0.53, 0.3),
    ) -> None:
        """Add an object to the scene, or replace the one of the same name.

        Args:
            name: name of the object.
            center: x and y of its middle.
            size: size along x and y.
            color: red, green and blue, 0 to 1.
        """
        raise WorldError(f"nothing can be placed in the world {type(self).__name__}", where=name)

    @property
    def stage(self) -> World:
        """The world whose objects the methods for objects change: this one, or one inside of it."""
        return self

    @property
    def can_place(self) -> bool:
        """Whether `place` adds objects."""
        return type(self.stage).place is not World.place

    def remove(self, name: str) -> None:
        """Remove an object from the scene."""
        raise WorldError(f"nothing can be removed from the world {type(self).__name__}", where=name)

    def push(self, body: str, force: Sequence[float]) -> None:
        """Push a body with a force along x, y and z (N) until the next call; a force of 0 ends it."""
        raise WorldError(f"nothing in the world {type(self).__name__} can be pushed", where=body)

    def arrangement(self) -> Any:
        """Return the present state of everything that `place`, `move` and `remove` change, for `arrange`.

        Actions of experiments and snapshots of sessions need both methods; files hold plain data only.
        """
        raise WorldError(f"the world {type(self).__name__} does not list its objects")

    def arrange(self, kept: Any) -> None:
        """Restore the objects as they were when `arrangement` returned `kept`."""
        raise WorldError(f"the world {type(self).__name__} cannot restore its objects")

    def describe(self) -> dict[str, Json]:
        """Return the description of the world that a record stores, as plain data."""
        return {"world": type(self).__name__}

    @classmethod
    def open(cls, argument: str) -> World:
        """Make a world from an argument of the command line.

        For `--world picture:coffee.jpg` the argument is `coffee.jpg`.

        Raises:
            WorldError: the argument describes no such world.
        """
        raise WorldError(f"the world {cls.__name__} cannot be opened from the command line")

    @classmethod
    def names(cls) -> list[str]:
        """Return the names that `open` accepts besides files, such as those of built-in arenas."""
        return []

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> World:
        """Open a world again from the description that `describe` returned: from the file that it names, or
        without arguments if the class takes none.
        """
        file = described.get("file")
        if isinstance(file, str) and file != "array":
            return cls.open(file)
        if cls.open.__func__ is World.open.__func__ and not inspect.signature(cls).parameters:
            return cls()
        raise WorldError(f"the world {cls.__name__} was not opened from a file")

    def require(self, sensor: str) -> None:
        """Raise WorldError if this world has no such sensor."""
        if sensor not in self.sensors:
            raise WorldError(
                f"the world {type(self).__name__} has no sensor {sensor!r}",
                fix=_hint(sensor, self.sensors, "sensors"),
            )

    def require_motor(self, motor: str) -> None:
        """Raise WorldError if this world has no such motor."""
        if motor not in self.motors:
            raise WorldError(
                f"the world {type(self).__name__} has no motor {motor!r}",
                fix=_hint(motor, self.motors, "motors"),
            )

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        """Yield what is wrong with the axes over which a model reads a sensor, besides their shape.

        Problems prevent a run, warnings do not; the caller fills in `where`.
        """
        return iter(())

    def validate(self) -> Iterator[Problem]:
        """Yield what is wrong with the world itself, such as objects at one place.

        Problems prevent a run, warnings do not.
        """
        return iter(())

    def validate_object(self, name: str) -> Iterator[Problem]:
        """Yield warnings about an object that an action placed or moved, such as another one at its place."""
        return iter(())

    def alternative(self, signal: str, shape: Sequence[int]) -> str:
        """Return what to type for a world of this kind in which a signal has a shape; empty: none known."""
        return ""

    @classmethod
    def examples(cls) -> Iterator[World]:
        """Yield the worlds from which the studio takes one if the user chose none: the first in which a model
        runs without a warning. By default the only one is `example()`.
        """
        kind: Any = cls
        yield kind.example()

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        """Return axes over which a sensor of the example can be read."""
        raise NotImplementedError


def fitting(name: str, signal: Signal, axes: Axes) -> None:
    """Raise WorldError if the axes do not have the shape of a sensor or motor."""
    if signal.shape is not None and shape(axes) != signal.shape:
        expected = (
            "no axes, it is one number"
            if not signal.shape
            else "axes of " + " x ".join(map(str, signal.shape)) + " samples"
        )
        raise WorldError(f"{name!r} has {expected}; the model gives it {list(shape(axes))}")


def _hint(name: str, signals: Mapping[str, Signal], direction: str) -> str:
    if not signals:
        return f"It has no {direction}"
    hint = did_you_mean(name, signals)
    return hint if hint.startswith("Valid names") else f"{hint} Valid names: {', '.join(sorted(signals))}"
