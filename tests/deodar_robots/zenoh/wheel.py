"""A world for tests: a wheel that writes each command, with the time, to a file."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal, World


class Wheel(World):
    """A wheel: its angle follows the speed that is commanded."""

    sensors = {"angle": Signal("angle", (), "rad")}
    motors = {"speed": Signal("speed", (), "rad/s")}
    period = 10.0
    stands_in = False

    def __init__(self, file: str = "") -> None:
        self.file = Path(file) if file else None
        self.angle = 0.0

    def reset(self, seed, trials=(0,), precision="float32"):
        self.angle = 0.0

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return np.float32(self.angle)

    def act(self, motors: Mapping[str, np.ndarray], now: float) -> None:
        speed = float(motors["speed"][0]) if "speed" in motors else 0.0
        if speed > 1e6:
            raise RuntimeError("the wheel flew off")
        self.angle += speed * self.period / 1000
        if self.file is not None:
            with self.file.open("a", encoding="utf-8") as log:
                log.write(f"{time.monotonic():.6f} {speed}\n")

    def keep(self):
        return np.float64(self.angle)

    def put(self, kept) -> None:
        self.angle = float(kept)
