"""The view of a plane through a camera, as a map of that plane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.numerics import homography
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.resampling import INTERPOLATIONS
from deodar.parameters import ArrayLike, FrozenArray, Rebuild, Recompile
from deodar.registry import register

CORNERS = FrozenArray(np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]]))

LEAST_SPREAD = 1e-3
"""Smallest triangle of three of the points, as a share of the largest one, below which they count as lying on
one line.
"""


@register
@dataclass(frozen=True)
class Homography(Coupling):
    r"""A picture of a plane, such as a table, resampled over that plane.

    Four points of the plane and their positions in the picture determine the projective map H from the plane
    to the picture of any camera without distortion. Each sample of the output takes the value of the picture
    where H places it, and 0 where that lies outside of the picture.

    Equation:
        (c, r)^T = \frac{(a_1, a_2)^T}{a_3},\quad a = H\, (x, y, 1)^T
        y(x, y) = \mathrm{input}(c, r)

    Parameters:
        axes: the two dimensions of the plane.
        picture: the four points in the picture, on its first and second axis, in the units of these axes; no
            three on one line.
        plane: the same four points in the plane, in the units of `axes`, in the same order.
        interpolation: `nearest` (the value of one pixel, so that no colours are mixed) or `linear` (of the
            four pixels around).

    Ports:
        input: a picture: two dimensions, then any others, such as channels.
        output: over `axes`, then the other axes of the input.

    Shapes:
        picture: four rows of two numbers.
        plane: the same.

    Reference:
        Hartley & Zisserman (2004), Multiple View Geometry in Computer Vision, 2nd ed., section 2.3. Lomp,
        Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 5 (the camera above the table).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="two dimensions of the plane")] = ()
    picture: Annotated[ArrayLike, Rebuild(meaning="four points in the picture")] = CORNERS
    plane: Annotated[ArrayLike, Rebuild(meaning="the same points in the plane")] = CORNERS
    interpolation: Annotated[
        str, Recompile(choices=INTERPOLATIONS, meaning="nearest pixel, or the four around")
    ] = "nearest"

    linear: ClassVar[bool] = True

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return arriving

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (*self.axes, *ins["input"][2:])}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        if len(self.axes) != 2 or len(ins["input"]) < 2:
            yield (
                f"maps a picture of two dimensions onto a plane of two; it has {len(self.axes)} axes, and its"
                f" input {len(ins['input'])}",
                "Give it axes=[x, y], and a picture over columns and rows",
            )
        for name in ("picture", "plane"):
            points = getattr(self, name)
            wrong = list(wrong_shape(name, points, (homography.PAIRS, 2), "four points need"))
            yield from wrong
            if not wrong and isinstance(points, FrozenArray):
                share = float(homography.spread(jnp.asarray(points.data, float)))
                if not share > LEAST_SPREAD:
                    yield (
                        f"three of the points in {name} lie on one line, so they determine no map",
                        "Use the four corners of a rectangle on the plane",
                    )

    def jumps_at(self) -> Sequence[str]:
        return ("picture", "plane") if self.interpolation == "nearest" else ()

    def prepare(self, at: Setting) -> Arrays:
        x, y = (at.points(axis) for axis in self.axes)
        picture, plane = at.array(self.picture), at.array(self.plane)
        points = jnp.stack(jnp.meshgrid(x, y, indexing="ij"), axis=-1)
        matrix = homography.homography(plane, picture)
        seen = homography.mapped(matrix, points)
        source = at.ins["input"][:2]
        start, step = (np.array([getattr(a, name) for a in source], at.dtype) for name in ("lower", "step"))
        visible = homography.in_front(matrix, points, plane[0])[..., None]
        outside = -2.0  # one sample and more before the first
        return {"samples": jnp.where(visible & jnp.isfinite(seen), (seen - start) / step, outside)}

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        picture, position = inputs["input"], constants["samples"]
        counts = np.array(shape(at.ins["input"][:2]))
        if self.interpolation == "nearest":
            return {"output": _pixel(picture, jnp.floor(position + 0.5), counts)}
        low = jnp.floor(position)
        part = position - low
        y = jnp.zeros((), picture.dtype)
        for corner in ((0, 0), (0, 1), (1, 0), (1, 1)):
            share = jnp.prod(jnp.where(np.array(corner) == 1, part, 1 - part), axis=-1)
            share = share.reshape(share.shape + (1,) * (picture.ndim - 2))
            y = y + share * _pixel(picture, low + np.array(corner), counts)
        return {"output": y}

    @classmethod
    def example(cls) -> Homography:
        x, y = (Axis(name, 0, 20, samples=11) for name in ("x", "y"))
        seen = np.array([[2.0, 1.0], [18.0, 1.0], [20.0, 19.0], [0.0, 19.0]])
        return cls([x, y], picture=seen, plane=CORNERS.data, name="example")


def _pixel(picture: Array, index: Array, counts: np.ndarray) -> Array:
    """Return the values of pixels by their numbers along both axes; 0 outside of the picture."""
    inside = jnp.all((index >= 0) & (index < counts), axis=-1)
    place = jnp.where(inside[..., None], index, 0).astype(jnp.int32)
    flat = picture.reshape((-1, *picture.shape[2:]))
    values = jnp.take(flat, place[..., 0] * int(counts[1]) + place[..., 1], axis=0, mode="clip")
    return jnp.where(inside.reshape(inside.shape + (1,) * (picture.ndim - 2)), values, 0)
