"""A model as the world of another model: motors of one are sensors of the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from deodar.codec import Json
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import ModelError, WorldError
from deodar.model.document import Document
from deodar.model.model import Model, load
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import Axes, shape
from deodar.session.session import Session
from deodar.worlds._base import Signal, World


class ModelWorld(World):
    r"""A model that another one moves: its sensors are the motors of this world, its motors the sensors.

    Both models exchange in every step, and both read what the other one sent one step before. So a model that
    is divided into two computes what it computes with `delayed` connections in their place: up to rounding,
    and to the bit where both processes use `dd.use_separate_rounding`.

    Equation:
        y(t) = m_{\mathrm{model}}(t - dt),\quad s_{\mathrm{model}}(t) = m(t - dt)

    Args:
        model: the model; each of its motors and sensors has a name of its own.

    Attributes:
        session: the session that runs the model; None before `reset`.
    """

    stands_in = False
    repeatable = False

    def __init__(self, model: Model) -> None:
        doc = model.document
        sensors, motors = _parts(doc)
        if not sensors and not motors:
            raise ModelError("has no sensor and no motor by which another model could reach it", doc.name)
        self.model, self.name = model, doc.name
        self.period = doc.step * unit_seconds(doc.time_unit) * 1e3
        self.sensors = {name: Signal(f"command of {path}", size) for name, (path, size) in motors.items()}
        self.motors = {name: Signal(f"reading of {path}", size) for name, (path, size) in sensors.items()}
        self.session: Session | None = None
        self._inlet = _Inlet(self.motors, self.sensors, self.period)
        self._watched = next(e.path for e in doc.entries if isinstance(e.element, (Motor, Sensor)))

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if len(trials) != 1:
            raise WorldError(f"the model {self.name!r} runs one trial at a time")
        self._inlet.reset(seed)
        self.session = Session(
            self.model, seed=seed, precision=precision, world=self._inlet, trial=int(trials[0])
        )
        self._exchange(self.session)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return self._inlet.commands[sensor]

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        if self.session is None:
            raise WorldError(f"the model {self.name!r} has not begun", fix="Type: world.reset(seed)")
        self.session.step()
        self._inlet.readings |= {name: np.asarray(value[0]) for name, value in motors.items()}
        self._exchange(self.session)

    def _exchange(self, session: Session) -> None:
        """Let the model send its commands of the last step, and read those of the other model."""
        session.read(f"{self._watched}.output")

    def describe(self) -> dict[str, Json]:
        return {"world": "ModelWorld", "model": self.name}

    @classmethod
    def open(cls, argument: str) -> ModelWorld:
        return cls(load(argument))


class _Inlet(World):
    """The world of the model that is served: what the other model sends, and what it gets."""

    stands_in = False

    def __init__(self, sensors: Mapping[str, Signal], motors: Mapping[str, Signal], period: float) -> None:
        self.sensors, self.motors, self.period = sensors, motors, period
        self.reset(0)

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self.readings = {name: np.zeros(signal.shape or ()) for name, signal in self.sensors.items()}
        self.commands = {name: np.zeros(signal.shape or ()) for name, signal in self.motors.items()}

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self.readings[sensor]

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self.commands |= {name: np.asarray(value[0]) for name, value in motors.items()}


def _parts(doc: Document) -> tuple[dict[str, tuple[str, tuple[int, ...]]], ...]:
    """Return path and shape of the sensors, and of the motors, by the names of their signals."""
    sensors: dict[str, tuple[str, tuple[int, ...]]] = {}
    motors: dict[str, tuple[str, tuple[int, ...]]] = {}
    for entry in doc.entries:
        part = entry.element
        if isinstance(part, (Sensor, Motor)):
            into, name = (sensors, part.sensor) if isinstance(part, Sensor) else (motors, part.motor)
            size = shape(tuple(part.axes))
            if into.get(name, ("", size))[1] != size:
                raise ModelError(f"reads {name!r} over other axes than {into[name][0]}", where=entry.path)
            into[name] = entry.path, size
    return sensors, motors
