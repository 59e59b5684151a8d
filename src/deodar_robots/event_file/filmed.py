"""A video before an event camera: the events that its pixels send while it plays."""

from __future__ import annotations

import functools
import math
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from deodar.element import Arrays
from deodar.errors import WorldError
from deodar.numerics.axes import Axis
from deodar.numerics.noise import element_keys
from deodar.numerics.processor import on_cpu
from deodar.worlds._capture import VideoReader
from deodar.worlds._image import sampled
from deodar.worlds._pure import number
from deodar_robots.eye.event_camera import EventCamera

LUMA = (0.299, 0.587, 0.114)
"""Weights of red, green and blue in the luma of a video (Rec. 601)."""

DARK = 8.0
"""Luma, of 255, that is added before the logarithm, so that the noise of dark pictures causes no events."""


class FilmedEvents:
    """Events of a video, computed period by period.

    Attributes:
        size: columns and rows of the sensor.
    """

    def __init__(
        self, path: Path, size: tuple[int, int], camera: EventCamera, period: float, loop: bool
    ) -> None:
        self.size, self.camera, self.period, self.loop = size, camera, period, loop
        self._reader = VideoReader(path)
        if not math.isfinite(self._reader.rate):
            raise WorldError("states no rate of its pictures", where=str(path))
        columns, rows = size
        # a periodic axis may have one sample
        self._axes = (
            Axis("column", 0, columns, columns, periodic=True),
            Axis("row", 0, rows, rows, periodic=True),
            Axis("channel", 0, 2, 3),
        )
        self._seen: dict[int, np.ndarray] = {}
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Return to the first picture; `seed` is that of thresholds and noise."""
        self._seed, self._tick = seed, 0
        with on_cpu():
            key = element_keys(jnp.asarray(seed, jnp.uint32), 0, [number("pixels")])[0]
            start = _start(self.camera)(self._luminance(0.0), key)
        self._key, self._state = np.asarray(key), _plain(start)

    def counts(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of on and off events of each pixel in the last whole period before a time in ms.

        They follow from the seed and the time alone: other times may have been asked for before.
        """
        tick = max(0, int(time / self.period + 1e-6))
        if tick < self._tick:
            self.reset(self._seed)
        while self._tick < tick and not self._over(self._tick):
            self._tick += 1
            with on_cpu():
                expose = _exposure(self.camera, self.period)
                luminance = self._luminance(self._tick * self.period)
                self._state = _plain(expose(self._state, luminance, self._key, np.uint32(self._tick)))
        if self._tick < tick:
            return np.zeros(self.size), np.zeros(self.size)
        return self._state["on"], self._state["off"]

    def close(self) -> None:
        """Close the video; the next period that is computed opens it again."""
        self._reader.close()

    def keep(self) -> dict[str, np.ndarray]:
        """Return the state of the pixels, as an argument for `put`."""
        return {**self._state, "tick": np.asarray(self._tick), "seed": np.asarray(self._seed)}

    def put(self, kept: dict[str, Any]) -> None:
        """Restore a state that `keep` returned."""
        state = {name: np.asarray(value) for name, value in kept.items()}
        self.reset(int(state.pop("seed")))
        self._tick, self._state = int(state.pop("tick")), state

    def _over(self, tick: int) -> bool:
        """Return whether the video has ended at the beginning of the period after this tick."""
        pictures = self._reader.pictures
        ended = pictures is not None and tick * self.period * self._reader.rate / 1000 >= pictures
        return ended and not self.loop

    def _luminance(self, time: float) -> np.ndarray:
        """Return the log luminance at a time in ms, (columns, rows): linear between two pictures."""
        place = time * self._reader.rate / 1000
        before = int(place + 1e-6)
        share = np.float32(min(max(place - before, 0.0), 1.0))
        one, other = self._picture(before), self._picture(before + 1)
        self._seen = {k: seen for k, seen in self._seen.items() if k >= before}
        return one + share * (other - one)

    def _picture(self, place: int) -> np.ndarray:
        """Return the log luminance of a picture, from 0 on, or from the first one again with `loop`."""
        if place not in self._seen:
            pixels = self._reader.picture((place + 0.5) * 1000 / self._reader.rate, self.loop)
            luma = 255 * sampled(pixels, self._axes, "events") @ np.asarray(LUMA, np.float32)
            self._seen[place] = np.log(luma + np.float32(DARK)).astype(np.float32)
        return self._seen[place]


@functools.lru_cache(maxsize=16)
def _start(camera: EventCamera) -> Any:
    """Return the compiled function of the start."""
    return jax.jit(camera.start)


@functools.lru_cache(maxsize=16)
def _exposure(camera: EventCamera, period: float) -> Any:
    """Return the compiled function of one period."""

    @jax.jit
    def expose(state: Arrays, luminance: jax.Array, key: jax.Array, tick: jax.Array) -> Arrays:
        return camera.expose(state, luminance, period, key, tick)

    return expose


def _plain(state: Any) -> dict[str, np.ndarray]:
    return {name: np.asarray(value, np.float32) for name, value in state.items()}
