"""The picture of a vehicle's colour camera among boxes, and its noise, as pure functions of one copy.

The camera is a pinhole that looks straight ahead, parallel to the floor. Columns run from the left to the
right and rows from the top to the bottom, both equally spaced in the image plane. A pixel has the colour of
the surface that the ray through its middle meets first: a side or the top of a box, or the floor; the
background where the ray meets none.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.element import Arrays
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.numerics.colors import hue_saturation_value, red_green_blue
from deodar.numerics.copies import computed_once
from deodar.numerics.noise import box_muller, uniform, words
from deodar.worlds.arena.vehicle import VehicleCamera, ahead
from deodar.worlds.arena.view import FLOOR

NEAREST = 1e-6
"""Smallest depth of a surface, m: that of a box around the camera. A depth of 0 with the number of a box in
its last bits would be a denormal number, with which processors compute slowly.
"""

AT_ONCE = 48
"""Number of boxes whose depths are compared in one loop over the pixels; more take longer to compile."""


def slopes(samples: int, angle: float) -> np.ndarray:
    """Return the slopes of the rays of a row or column of pixels, positive to the left or upwards, falling.

    The slope is the offset in the image plane at distance 1; pixel middles are equally spaced in it::

        slope_i = tan(angle / 2) * (1 - (2 i + 1) / samples)
    """
    return math.tan(angle / 2) * (1 - (2 * np.arange(samples) + 1) / samples)


def picture_rays(camera: VehicleCamera, sensor: str, axes: Axes) -> tuple[np.ndarray, np.ndarray]:
    """Return the slopes of the columns and of the rows of a sensor's pixels; `line` has one row.

    The axes state the number of columns and rows; the picture always covers the whole field of view.

    Raises:
        WorldError: the sensor is sampled over other axes.
    """
    dimensions = 2 if sensor == "line" else 3
    if len(axes) != dimensions or axes[-1].samples != 3:
        shape = "columns and three channels" if dimensions == 2 else "columns, rows and three channels"
        raise WorldError(f"is seen over {shape}, not over {[a.samples for a in axes]} samples", where=sensor)
    columns = slopes(axes[0].samples, camera.horizontal)
    return columns, np.zeros(1) if dimensions == 2 else slopes(axes[1].samples, camera.vertical)


def surfaces(
    camera: VehicleCamera,
    pose: tuple[Array, Array],
    boxes: Array,
    heights: Array,
    present: Array,
    rays: tuple[np.ndarray, np.ndarray],
) -> Array:
    """Return for each pixel (columns, rows) the number of the box that it shows, n for the floor and n + 1
    for the background.

    A ray is a point that moves forward by 1 m, sideways by the slope of the column and upwards by the slope
    of the row. It is inside the footprint of a box between two depths, and between the floor and the top of
    the box between two others; it meets the box where both intervals begin to overlap. Depths are compared
    with a relative error of 2^-17 (for 64 boxes), because the number of the box replaces the last bits.

    Args:
        camera: the camera.
        pose: position (2,) and heading of the vehicle.
        boxes: (n, 4), m.
        heights: height of each box (n,), m.
        present: which boxes are present (n,).
        rays: slopes of the columns and of the rows.
    """
    count, dtype = len(boxes), boxes.dtype
    across, up = jnp.asarray(rays[0], dtype), rays[1]
    near, far = _footprints(camera, pose, boxes, across)
    far = jnp.where(present[:, None], far, -1.0)
    enter, leave = _between(camera, heights, jnp.asarray(up, dtype))
    loops = -(-count // AT_ONCE)
    per_loop = -(-count // loops)
    last = jnp.pad(far, ((0, loops * per_loop - count), (0, 0)), constant_values=-1.0)
    spans = [
        jnp.pad(a, ((0, loops * per_loop - count), (0, 0)))
        for a in (_numbered(near, count), _numbered(enter, count), leave)
    ]

    def nearer(k: Array | int, best: Array) -> Array:
        one, two, end, stop = (lax.dynamic_slice_in_dim(a, k * per_loop, per_loop) for a in (*spans, last))
        for b in range(per_loop):
            depth = jnp.maximum(one[b][:, None], two[b])
            best = jnp.minimum(
                best, jnp.where(depth <= jnp.minimum(stop[b][:, None], end[b]), depth, jnp.inf)
            )
        return best

    nothing = jnp.full((len(across), len(up)), jnp.inf, dtype)

    def nearest() -> Array:
        return nearer(0, nothing) if loops == 1 else lax.fori_loop(0, loops, nearer, nothing)

    best = computed_once(jnp.any(present), nearest, nothing)
    missed = np.where(up < 0, count, count + 1).astype(np.int32)
    return jnp.where(best < jnp.inf, _number(best, count), missed)


def _footprints(
    camera: VehicleCamera, pose: tuple[Array, Array], boxes: Array, across: Array
) -> tuple[Array, Array]:
    """Return the depths (n, columns) at which the rays enter and leave the footprint of each box."""
    position, heading = pose
    front = ahead(heading)
    eye = position + camera.forward * front
    rays = front + across[:, None] * jnp.stack([-front[1], front[0]])
    tiny = jnp.asarray(1e-30, boxes.dtype)
    inverse = 1.0 / jnp.where(jnp.abs(rays) < tiny, tiny, rays)
    to_lower, to_upper = ((side[:, None] - eye) * inverse for side in (boxes[:, :2], boxes[:, 2:]))
    near, far = (
        jnp.max(jnp.minimum(to_lower, to_upper), axis=-1),
        jnp.min(jnp.maximum(to_lower, to_upper), axis=-1),
    )
    return jnp.maximum(near, NEAREST), far


def _between(camera: VehicleCamera, heights: Array, up: Array) -> tuple[Array, Array]:
    """Return the depths (n, rows) at which the rays come between the floor and the top of each box, and leave
    this range; the second is negative for rays that pass above.
    """
    rise = (heights - camera.height)[:, None]
    tall, down = rise >= 0, up < 0
    slope = jnp.where(up == 0, jnp.asarray(1e-30, up.dtype), up)
    enter = jnp.maximum(jnp.where(~tall & down, rise / slope, 0.0), NEAREST)
    return enter, jnp.where(down, -camera.height / slope, jnp.where(tall, rise / slope, -1.0))


def _words(dtype: np.dtype[np.floating], count: int) -> tuple[type[np.unsignedinteger], int]:
    """Return the type of the bits of a number, and how many of them hold the number of a box."""
    return np.uint64 if np.dtype(dtype) == np.float64 else np.uint32, max(1, (count - 1).bit_length())


def _numbered(depths: Array, count: int) -> Array:
    """Replace the last bits of depths (n, samples) by the number of the row; the order of depths remains."""
    kind, bits = _words(depths.dtype, count)
    words = lax.bitcast_convert_type(depths, kind) >> kind(bits) << kind(bits)
    return lax.bitcast_convert_type(words | jnp.arange(count, dtype=kind)[:, None], depths.dtype)


def _number(depths: Array, count: int) -> Array:
    """Return the numbers that `_numbered` put into depths."""
    kind, bits = _words(depths.dtype, count)
    return (lax.bitcast_convert_type(depths, kind) & kind(2**bits - 1)).astype(jnp.int32)


BACKGROUND = (0.78, 0.78, 0.78)
"""Colour above the boxes."""

STRIPS = 20
"""Number of strips of clutter in the width of a picture."""

PARTS = {"camera": 0, "line": 1 << 31}
"""First number of the pixels of each sensor among those that key its noise."""

SECOND = 1 << 30
"""Offset of the pixels' numbers for their second pair of random words."""


@dataclass(frozen=True)
class PictureNoise:
    """Noise of one picture.

    Attributes:
        levels: by name: `pixel_noise`, standard deviation of each channel; `hue_noise`, standard deviation of
            the hue, degrees; `outliers`, share of the pixels that show a random saturated colour; `clutter`,
            share of the rows that strips of random colours cover. A name that is missing has no noise.
        keys: keys of the noises `pixels`, `hues` and `clutter`.
        tick: period of the world in which the picture was taken.
        sensor: `camera` or `line`.
    """

    levels: Mapping[str, Array]
    keys: Arrays
    tick: Array
    sensor: str

    @property
    def is_on(self) -> Array:
        """Whether there is any noise."""
        return jnp.any(jnp.stack(list(self.levels.values())) > 0)


def picture(numbers: Array, colours: Array, objects: int, noise: PictureNoise) -> Array:
    """Return the colours (columns, rows, 3) of numbered surfaces.

    Noise of the hue and outliers are applied first, then noise of the channels; the result is limited to 0
    and 1.

    Args:
        numbers: what each pixel shows: a box, n for the floor, n + 1 for the background (columns, rows).
        colours: colours of the boxes (n, 3).
        objects: number of the boxes that are objects; the others are the walls of the border.
        noise: noise of the picture.
    """
    palette = jnp.concatenate([colours, jnp.asarray([FLOOR, BACKGROUND], colours.dtype)])
    if "clutter" in noise.levels:
        numbers, palette = _cluttered(numbers, palette, objects, noise)
    if {"hue_noise", "outliers"} & set(noise.levels):
        seen = _hues_changed(numbers, palette, noise)
    else:
        seen = palette.at[numbers].get(mode="promise_in_bounds")
    if "pixel_noise" not in noise.levels:
        return seen
    return jnp.clip(
        seen + noise.levels["pixel_noise"] * _channels(numbers.shape, noise, seen.dtype), 0.0, 1.0
    )


def _cluttered(numbers: Array, palette: Array, objects: int, noise: PictureNoise) -> tuple[Array, Array]:
    """Cover pixels that show no object by strips of random colours; a strip covers a random range of the
    rows, which continues at the top where it ends below.
    """
    columns, rows = numbers.shape
    one, two = (uniform(w) for w in words(STRIPS, 0, noise.keys["clutter"], jnp.uint32(0)))
    strip = np.arange(columns) * STRIPS // columns
    below = (np.arange(rows) + 0.5) / rows - one[strip][:, None]
    covered = (below - jnp.floor(below) < noise.levels["clutter"]) & (numbers >= objects)
    ones = jnp.ones_like(two)
    random = red_green_blue(two, ones, ones).astype(palette.dtype)
    number = (len(palette) + strip).astype(np.int32)[:, None]
    return jnp.where(covered, number, numbers), jnp.concatenate([palette, random])


def _hues_changed(numbers: Array, palette: Array, noise: PictureNoise) -> Array:
    """Return the colours of pixels with noise of the hue and with outliers.

    One pair of random words is drawn for each pixel: the first decides whether it is an outlier. What is left
    of it then gives with the second one a standard normal deviate, or the second one the outlier's hue.
    """
    dtype = palette.dtype
    chance, turn = (uniform(w) for w in _pixel_words(numbers.shape, "hues", 0, noise))
    share = noise.levels.get("outliers", jnp.zeros((), dtype))
    is_outlier = chance < share
    remainder = jnp.clip((chance - share) / (1 - jnp.minimum(share, 0.999)), 2.0**-24, 1.0).astype(
        chance.dtype
    )
    deviate = (
        box_muller(remainder, turn, dtype)[0] * noise.levels.get("hue_noise", jnp.zeros((), dtype)) / 360
    )
    hue, saturation, value = hue_saturation_value(palette)
    of_surface = jnp.stack([hue, saturation * value, value])

    def changed() -> tuple[Array, Array, Array]:
        hue, chroma, value = (a.at[numbers].get(mode="promise_in_bounds") for a in of_surface)
        return (
            jnp.where(is_outlier, turn.astype(dtype), hue + deviate),
            jnp.where(is_outlier, 1.0, chroma),
            jnp.where(is_outlier, 1.0, value),
        )

    none = jnp.zeros(numbers.shape, dtype)
    return red_green_blue(*computed_once(noise.is_on, changed, (none, none, none)))


def _channels(shape: tuple[int, ...], noise: PictureNoise, dtype: np.dtype[np.floating]) -> Array:
    """Return standard normal deviates for the channels of each pixel."""
    pairs = [_pixel_words(shape, "pixels", offset, noise) for offset in (0, SECOND)]
    first, second = (box_muller(uniform(one), uniform(two), dtype) for one, two in pairs)
    return jnp.stack((*first, second[0]), axis=-1)


def _pixel_words(shape: tuple[int, ...], name: str, offset: int, noise: PictureNoise) -> tuple[Array, Array]:
    cells, first = shape[0] * shape[1], PARTS[noise.sensor] + offset
    none = jnp.zeros(cells, jnp.uint32)
    one, two = computed_once(
        noise.is_on, lambda: words(cells, first, noise.keys[name], noise.tick), (none, none)
    )
    return one.reshape(shape), two.reshape(shape)
