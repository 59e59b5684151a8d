"""The contract of a world: a plant with named sensors and motors, at its own rate.

Models name them; a world provides them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from deodar.errors import WorldError, did_you_mean
from deodar.numerics.axes import Axes, shape
from deodar.worlds._scene import Scene


@dataclass(frozen=True)
class Signal:
    """What a world says of one of its sensors or motors.

    Attributes:
        meaning: what it reads or moves, in words.
        shape: samples along each axis; None: whatever axes the model states, the world samples itself over
            them.
        unit: of the values; "" where they have none.
        period: ms between two new values; None: the world's own.
        each: whether every copy of a model reads its own (a robot of its own), or all the same (one camera).
    """

    meaning: str
    shape: tuple[int, ...] | None = None
    unit: str = ""
    period: float | None = None
    each: bool = False

    def __str__(self) -> str:
        samples = (
            "" if self.shape is None else " x ".join(map(str, self.shape)) if self.shape else "one number"
        )
        return "; ".join(part for part in (self.meaning, f"{samples} {self.unit}".strip()) if part)


class World:
    """A world on the host: it stands still while a model steps, and is read and told at its own rate.

    At each multiple t of the period the sensors are read and shown to the model, and the motors are read from
    it; what they do to the sensors shows at t + period. A world that moves by itself moves in `act`, or by
    the time that it is given.

    Several copies of a model (trials, points of a sweep) run at once; each has a robot of its own. Motors
    come with a leading axis of copies, and so do readings of sensors whose signal says `each`; other readings
    have none, all copies see the same.

    Class attributes:
        sensors: each sensor by name.
        motors: each motor by name.
        stands_in: whether its example may stand in where no world was chosen; not where it needs an extra, or
            a device.

    Attributes:
        period: ms between two exchanges; None: the world never changes, one reading serves a whole run.
    """

    sensors: Mapping[str, Signal] = {}
    motors: Mapping[str, Signal] = {}
    period: float | None = None
    stands_in: ClassVar[bool] = True

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        """Put the world back to its start.

        Args:
            seed: of all noise.
            trials: the trial of each copy; copies of one trial see the same noise.
            precision: of the model's numbers, float32 or float64; a simulated world computes in it too.
        """

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        """What a sensor reads at a time (ms), sampled over the axes: finite, of their shape, with copies
        first where the signal says `each`.
        """
        raise NotImplementedError

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        """Go on by one period from `time` (ms), with what the motors were told then: for each driven motor an
        array, copies first.
        """

    def keep(self) -> Any:
        """What `put` needs to go back to this moment."""
        return None

    def put(self, kept: Any) -> None:
        """Back to a moment that `keep` kept."""

    def scene(self) -> Scene | None:
        """What there is to see from above, now; None: nothing that could be drawn so."""
        return None

    def move(self, name: str, center: Sequence[float]) -> None:
        """Put a thing or a mark of the scene elsewhere: x and y of its middle."""
        raise WorldError(f"nothing in the world {type(self).__name__} can be moved", where=name)

    def place(
        self,
        name: str,
        center: Sequence[float],
        size: Sequence[float],
        color: Sequence[float] = (0.72, 0.53, 0.3),
    ) -> None:
        """Put a thing there, or replace the one of that name: x and y of its middle, its size along both,
        red, green and blue from 0 to 1.
        """
        raise WorldError(f"nothing can be placed in the world {type(self).__name__}", where=name)

    def remove(self, name: str) -> None:
        """Take a thing away."""
        raise WorldError(f"nothing can be taken out of the world {type(self).__name__}", where=name)

    def arrangement(self) -> Any:
        """All that `place`, `move` and `remove` change, as it is now, for `arrange`.

        Actions of experiments need both methods.
        """
        raise WorldError(f"the world {type(self).__name__} does not say what its things are")

    def arrange(self, kept: Any) -> None:
        """Put things back as they were when `arrangement` returned `kept`."""
        raise WorldError(f"the world {type(self).__name__} cannot put its things back")

    def describe(self) -> dict[str, Any]:
        """What a record keeps of the world, as plain data."""
        return {"world": type(self).__name__}

    @classmethod
    def open(cls, argument: str) -> World:
        """The world that the command line names: `--world picture:coffee.jpg` gives `coffee.jpg`."""
        raise WorldError(f"the world {cls.__name__} cannot be opened from the command line")

    @classmethod
    def again(cls, described: Mapping[str, Any]) -> World:
        """The world that `describe` told a record of, opened again."""
        file = described.get("file")
        if not isinstance(file, str) or file == "array":
            raise WorldError(f"the world {cls.__name__} was not opened from a file")
        return cls.open(file)

    def require(self, sensor: str) -> None:
        """Refuse a sensor that this world does not have."""
        if sensor not in self.sensors:
            raise WorldError(
                f"the world {type(self).__name__} has no sensor {sensor!r}",
                fix=_hint(sensor, self.sensors, "sensors"),
            )

    def require_motor(self, motor: str) -> None:
        """Refuse a motor that this world does not have."""
        if motor not in self.motors:
            raise WorldError(
                f"the world {type(self).__name__} has no motor {motor!r}",
                fix=_hint(motor, self.motors, "motors"),
            )

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        """Axes over which a sensor of the example can be read."""
        raise NotImplementedError


def fitting(name: str, signal: Signal, axes: Axes) -> None:
    """Refuse axes over which a sensor or motor is not sampled."""
    if signal.shape is not None and shape(axes) != signal.shape:
        wanted = (
            "no axes, it is one number"
            if not signal.shape
            else "axes of " + " x ".join(map(str, signal.shape)) + " samples"
        )
        raise WorldError(f"{name!r} has {wanted}; the model gives it {list(shape(axes))}")


def _hint(name: str, known: Mapping[str, Signal], what: str) -> str:
    if not known:
        return f"It has no {what}"
    near = did_you_mean(name, known)
    return near if near.startswith("There is") else f"{near} There is: {', '.join(sorted(known))}"
