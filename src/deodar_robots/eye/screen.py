"""The screen in front of the camera: a blinking target and distractors, as pure functions of one copy."""

from __future__ import annotations

import dataclasses as dc
from typing import Annotated

import jax.numpy as jnp
from jax import Array
from jax.typing import DTypeLike

from deodar.declarations import Recompile
from deodar.numerics.noise import uniform, words
from deodar.worlds._settings import From0, PositiveNumber, WorldSettings
from deodar_robots.eye.pan_tilt import PIXELS, PanTilt

CANDIDATES = 32
"""Random places from which the place of a new object is taken: the first one within the screen."""


@dc.dataclass(frozen=True)
class EyeScreen(WorldSettings):
    """What a screen shows, and how it moves.

    Attributes:
        radius: radius of the discs, pixels.
        contrast: log luminance of a lit disc, above the ground.
        blink: time for which the target is lit, and then dark, ms.
        distractors: number of discs besides the target; they do not blink.
        speed: speed of the target in a random direction, servo units per second.
        drift: speed of the distractors, likewise.
        reach: half the side of the screen, servo units; its middle is at 1000. Small enough that no gaze at
            the screen ends at a limit of the servo motors.
        wait: time before the first target, ms.
        endless: whether the screen shows another target after a gaze, when the target is lost, and after 4 s.
    """

    radius: PositiveNumber = 4.0
    contrast: float = 1.0
    blink: PositiveNumber = 40.0
    distractors: Annotated[int, Recompile(lower=0)] = 0
    speed: From0 = 0.0
    drift: From0 = 0.0
    reach: PositiveNumber = 600.0
    wait: From0 = 0.0
    endless: bool = True


def luminance(places: Array, bright: Array, radius: float, dtype: DTypeLike) -> Array:
    """Return the log luminance of the picture on the retina, shape (columns, rows); the ground is 0.

    Args:
        places: column and row of the middle of each disc, (objects, 2).
        bright: luminance of each disc above that of the ground, as a share of the latter; 0: it is dark.
        radius: radius of the discs, pixels; their edge is one pixel wide.
        dtype: precision.
    """
    pixel = jnp.arange(PIXELS, dtype=dtype)
    light = jnp.ones((PIXELS, PIXELS), dtype)
    for k in range(places.shape[0]):
        x, y = pixel - places[k, 0], pixel - places[k, 1]
        away = jnp.sqrt((x * x)[:, None] + (y * y)[None, :])
        cover = jnp.clip(radius + 0.5 - away, 0.0, 1.0)
        light = light + cover * bright[k]
    return jnp.log(light)


def drawn(
    optics: PanTilt, pose: Array, middle: float, reach: float, margin: float, key: Array, block: Array
) -> Array:
    """Return a random direction of a new object: visible, and on the screen if possible.

    The place is uniform on the retina, `margin` pixels inside its border. The first of 32 places is taken
    whose direction is within the screen; if none is, the one nearest to it.

    Args:
        optics: the optics of the camera.
        pose: pan and tilt of the camera, servo units.
        middle: pan and tilt of the middle of the screen.
        reach: half the side of the screen, servo units.
        margin: pixels.
        key: key of the random numbers.
        block: their counter.
    """
    a, b = words(CANDIDATES, 0, key, block)
    share = jnp.stack([uniform(a), uniform(b)], axis=-1).astype(pose.dtype)
    places = margin + share * (PIXELS - 1 - 2 * margin)
    directions = pose + optics.to_direction(places)
    beyond = jnp.maximum(jnp.max(jnp.abs(directions - middle), axis=-1) - reach, 0.0)
    return directions[jnp.argmin(beyond)]


def headings(count: int, speed: float, key: Array, block: Array, dtype: DTypeLike) -> Array:
    """Return random velocities of objects, (count, 2), servo units per ms; `speed` is per second."""
    a, _ = words(count, CANDIDATES, key, block)
    turn = 2 * jnp.pi * uniform(a).astype(dtype)
    return speed / 1000 * jnp.stack([jnp.cos(turn), jnp.sin(turn)], axis=-1)
