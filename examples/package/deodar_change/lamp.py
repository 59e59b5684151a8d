"""A lamp that is switched on at a time."""

from __future__ import annotations

from typing import Any

import numpy as np

import deodar as dd


@dd.register
class Lamp(dd.World):
    """A lamp: dark before a time, bright from then on.

    Args:
        on: time at which it is switched on, in ms.
    """

    sensors = {"light": dd.Signal("brightness", (), "lux")}
    period = 10.0

    def __init__(self, on: float = 100.0) -> None:
        self.on = on

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        return np.asarray(10.0 if time >= self.on else 0.0)

    def describe(self) -> dict[str, Any]:
        return {"world": "Lamp", "file": f"{self.on:g}"}

    @classmethod
    def open(cls, argument: str) -> Lamp:
        try:
            return cls(float(argument))
        except ValueError:
            what = f"needs the time at which it is switched on, in ms, not {argument!r}"
            raise dd.errors.WorldError(what, where="lamp", fix="Write lamp:100") from None

    @classmethod
    def example(cls) -> Lamp:
        return cls()

    @staticmethod
    def example_axes(sensor: str) -> dd.Axes:
        return ()
