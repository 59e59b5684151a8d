"""A recorded run as a world."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import Fix, WorldError
from deodar.numerics.axes import Axes, Axis
from deodar.registry import register
from deodar.worlds._base import Signal, World

UNITS = {"us": 1e-3, "ms": 1.0, "s": 1e3, "min": 6e4, "abstract": 1.0}
"""Units of recorded times, in ms."""

NEAR = 1e-6


@register
class Recording(World):
    r"""Replay of the sensors of a recorded run: open loop, exact.

    Each sensor shows its output at the last recorded time. Motors are accepted and have no effect. The same
    model with the same seed repeats the recorded run if every reading was recorded.

    Equation:
        y(t) = \mathrm{recorded}(t_k),\quad t_k \le t < t_{k+1}

    Parameters:
        record: an `xarray.Dataset` that `simulate` returned, with the output of sensors among its variables.
        file: path of the file that the record was read from; "" if it was not read from a file.

    Shapes:
        Each sensor has the axes it was recorded over. If the record has trials, each copy of a model reads
        its own trial.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 3.2 (recorded input instead
        of sensors).
    """

    opens = (".zarr", ".nc")

    def __init__(self, record: xarray.Dataset, file: str = "") -> None:
        if not isinstance(record, xarray.Dataset) or "time" not in record.dims:
            raise WorldError(
                "is not a record of a run",
                where=file,
                fix=Fix("Give what simulate returned", "Name a record: --world recording:run.zarr"),
            )
        self.file = file
        elements = _elements(record, file)
        self.times = np.asarray(record["time"].values, float) * _unit(
            str(record["time"].attrs.get("units", "ms"))
        )
        if not len(self.times):
            raise WorldError("holds no time: its run was stopped before the first record", where=file)
        self.numbers = record["trial"].values.tolist() if "trial" in record.dims else None
        self._readings: dict[str, np.ndarray] = {}
        sensors: dict[str, Signal] = {}
        for path, element in elements.items():
            name = f"{path}.output"
            if element.get("kind") != "Sensor" or name not in record:
                continue
            variable, sensor = record[name], str(element.get("sensor", "picture"))
            strange = [
                str(d)
                for d in variable.dims
                if d not in ("trial", "time") and d in record.coords and "lower" not in record[d].attrs
            ]
            if strange:
                raise WorldError(
                    f"was swept over {', '.join(strange)}",
                    where=name,
                    fix="Replay one point: record.sel({...})",
                )
            lead = [d for d in ("trial", "time") if d in variable.dims]
            values = variable.transpose(*lead, ...).values
            self._readings[sensor] = values
            sensors[sensor] = Signal(
                f"what {path} showed", values.shape[len(lead) :], each=self.numbers is not None
            )
        if not sensors:
            raise WorldError(
                "holds the output of no sensor", where=file, fix="Record it: record=['eye.output', ...]"
            )
        self.sensors = sensors
        motors = {
            path: str(e.get("motor", "left")) for path, e in elements.items() if e.get("kind") == "Motor"
        }
        self.motors = {name: Signal(f"accepted from {path}, without effect") for path, name in motors.items()}
        self.period = float(np.diff(self.times).min()) if len(self.times) > 1 else None
        self._copies: list[int] = []

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if self.numbers is not None:
            missing = [t for t in trials if t not in self.numbers]
            if missing:
                first_numbers = ", ".join(map(str, self.numbers[:8])) + (
                    ", ..." if len(self.numbers) > 8 else ""
                )
                raise WorldError(
                    f"holds no trial {missing[0]}",
                    where=self.file or "the record",
                    fix=f"Valid trials: {first_numbers}",
                )
            self._copies = [self.numbers.index(t) for t in trials]

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        gap = self.period or 1.0
        if time >= self.times[-1] + gap * (1 - NEAR):
            raise WorldError(
                f"ends at {self.times[-1]:g} ms, and the run continues to {time:g} ms",
                where=self.file or "the record",
            )
        k = max(0, int(np.searchsorted(self.times, time + gap * NEAR, side="right")) - 1)
        values = self._readings[sensor]
        return values[self._copies, k] if self.numbers is not None else values[k]

    def describe(self) -> JsonObject:
        digest = hashlib.sha256(self.times.tobytes())
        for sensor in sorted(self._readings):
            digest.update(sensor.encode() + self._readings[sensor].tobytes())
        return {
            "world": "Recording",
            "file": self.file,
            "sensors": sorted(self._readings),
            "sha256": digest.hexdigest(),
        }

    @classmethod
    def example(cls) -> Recording:
        """Return a recording of one sensor: 20 readings in each of two trials."""
        x, light = Axis("x", 0, 4, 5), np.arange(200.0, dtype=np.float32).reshape(2, 20, 5)
        elements = {"eye": {"kind": "Sensor", "sensor": "light"}, "leg": {"kind": "Motor", "motor": "left"}}
        coords: dict[str, Any] = {
            "trial": [0, 5],
            "time": ("time", np.arange(20) * 4.0, {"units": "ms"}),
            "x": ("x", x.points, {"lower": 0.0}),
        }
        about = {"deodar": codec.line({"document": {"elements": elements}}, ascii=True)}
        return cls(xarray.Dataset({"eye.output": (("trial", "time", "x"), light)}, coords, about))

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return (Axis("x", 0, 4, 5),)


def _elements(record: xarray.Dataset, file: str) -> Mapping[str, Mapping[str, Any]]:
    try:
        return codec.parse(record.attrs["deodar"])["document"]["elements"]
    except (KeyError, TypeError, ValueError):
        raise WorldError(
            "does not state the model that made it, so its sensors are unknown", where=file or "the record"
        ) from None


def _unit(text: str) -> float:
    if text in UNITS:
        return UNITS[text]
    _, _, number, unit = text.split()  # "1 = 64 ms"
    return float(number) * UNITS[unit]
