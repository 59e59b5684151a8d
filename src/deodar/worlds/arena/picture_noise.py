"""The colours of a camera's picture, with noise, as pure functions of one copy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays
from deodar.numerics.colors import hue_saturation_value, red_green_blue
from deodar.numerics.copies import computed_once
from deodar.numerics.noise import box_muller, uniform, words
from deodar.worlds.arena.view import FLOOR

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
