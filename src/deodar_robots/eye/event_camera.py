"""The pixels of an event camera, as pure functions of one copy, and the picture of its events."""

from __future__ import annotations

import math
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.noise import box_muller, uniform, words
from deodar.worlds._scene import ScenePicture

LEAST = 0.2
"""Smallest threshold of a pixel, as a share of the mean one: none is 0 or negative, whatever the spread."""


@dataclass(frozen=True)
class EventCamera:
    r"""An event camera: every pixel remembers the log luminance of its last event.

    When the log luminance L differs from the remembered one M by the pixel's threshold, the pixel sends an
    event (on for brighter, off for darker), and M moves by that threshold. The leak lowers M, which causes
    events of a dark, constant picture; shot noise adds events at random.

    Equation:
        n_{\mathrm{on}} = \min\left(\left\lfloor \frac{L - M}{\theta_{\mathrm{on}}} \right\rfloor,
            \left\lfloor \frac{T}{\mathrm{refractory}} \right\rfloor\right)

    Attributes:
        threshold: mean threshold, in natural log units.
        spread: standard deviation of the thresholds of pixels, as a share of `threshold`.
        refractory: shortest time between two events of a pixel, ms.
        leak: rate of the events that the leak causes, per pixel and second.
        shot: rate of the events of shot noise, per pixel and second, on and off in equal parts. A pixel has
            at most one of them in a period.

    Reference:
        Lichtsteiner, Posch & Delbruck (2008), IEEE J. Solid-State Circuits 43, 566-576 (the pixel); Hu, Liu &
        Delbruck (2021), v2e, CVPR Workshops (threshold mismatch, leak and shot noise).
    """

    threshold: float = 0.2
    spread: float = 0.03
    refractory: float = 1.0
    leak: float = 0.1
    shot: float = 0.5

    def start(self, luminance: Array, key: Array) -> Arrays:
        """Return the state of pixels that have adapted to a picture of log luminance, shape (columns, rows).

        The memory of each pixel is somewhere between two events, so that the leak does not fire them all at
        once.
        """
        shape, dtype = luminance.shape, luminance.dtype
        a, b = words(luminance.size, 0, key, jnp.uint32(0))
        on, off = box_muller(uniform(a), uniform(b), dtype)
        on, off = (self.threshold * jnp.maximum(1 + self.spread * d.reshape(shape), LEAST) for d in (on, off))
        phase, _ = words(luminance.size, 0, key, jnp.uint32(1))
        memory = luminance - on * uniform(phase).astype(dtype).reshape(shape) * (self.leak > 0)
        nothing = jnp.zeros(shape, dtype)
        return {"on threshold": on, "off threshold": off, "memory": memory, "on": nothing, "off": nothing}

    def expose(self, state: Arrays, luminance: Array, period: float, key: Array, tick: Array) -> Arrays:
        """Return the state one period (ms) later; `on` and `off` are the numbers of events in this period."""
        most = math.floor(period / self.refractory) if self.refractory > 0 else math.inf
        up, down = state["on threshold"], state["off threshold"]
        memory = state["memory"] - self.leak * period / 1000 * up
        away = luminance - memory
        on = jnp.clip(jnp.floor(away / up), 0, most)
        off = jnp.clip(jnp.floor(-away / down), 0, most)
        memory = memory + on * up - off * down
        if self.shot > 0:
            word, _ = words(luminance.size, 0, key, tick)
            share = uniform(word).reshape(luminance.shape)
            half = self.shot * period / 2000
            on = on + (share < half).astype(on.dtype)
            off = off + (share > 1 - half).astype(on.dtype)
        return {**state, "memory": memory, "on": on, "off": off}


def rate(events: Array, axes: Axes, period: float) -> Array:
    """Return the mean rate of events over the cell of each sample, per pixel and second.

    Args:
        events: number of events of each pixel in a period, (columns, rows).
        axes: the two axes of the reading, in pixels; a cell outside of the sensor has no events.
        period: the period, ms.
    """
    one, other = (
        jnp.asarray(shares(axis, size), events.dtype) for axis, size in zip(axes, events.shape, strict=True)
    )
    return jnp.einsum("ic,cr,jr->ij", one, events, other) * (1000.0 / period)


def shares(axis: Axis, pixels: int) -> np.ndarray:
    """Return the share of a sample's cell that each pixel covers, (samples, pixels)."""
    low, high = axis.points - axis.step / 2, axis.points + axis.step / 2
    edges = np.arange(pixels + 1) - 0.5
    overlap = np.minimum(high[:, None], edges[None, 1:]) - np.maximum(low[:, None], edges[None, :-1])
    return np.maximum(overlap, 0.0) / axis.step


FADES = 40.0
"""Time after which an event has faded to 1/e, ms: longer than the page takes for a picture."""

FULL = 3.0
"""Events of a pixel that give it the full colour."""

NOTHING, ON, OFF = (np.asarray(c, float) for c in ((22, 24, 28), (255, 176, 64), (84, 160, 255)))
"""Red, green and blue of pixels without events, with on events and with off events: orange and blue differ
for people who do not see red and green apart.
"""


class EventPicture:
    r"""Events that fade, drawn in one colour for brighter and in another one for darker pixels.

    Equation:
        p \leftarrow p\, e^{-T / \mathrm{fades}} + n_{\mathrm{on}} - n_{\mathrm{off}}

    Args:
        side: columns and rows of the camera.
    """

    def __init__(self, side: int) -> None:
        self._levels = np.zeros((side, side))

    def clear(self) -> None:
        """Forget all events."""
        self._levels[:] = 0

    def add(self, on: np.ndarray, off: np.ndarray, period: float) -> None:
        """Add the numbers of events of a period (ms), columns first."""
        self._levels *= math.exp(-period / FADES)
        self._levels += on
        self._levels -= off

    def scene(self) -> ScenePicture:
        """Return the picture for the view of a world, with row 0 at the bottom, as plots draw it."""
        level = np.clip(self._levels.T[::-1] / FULL, -1, 1)[..., None]
        drawn = NOTHING + np.maximum(level, 0) * (ON - NOTHING) + np.maximum(-level, 0) * (OFF - NOTHING)
        rows, columns = drawn.shape[:2]
        return ScenePicture("events", columns, rows, drawn.round().astype(np.uint8).tobytes())
