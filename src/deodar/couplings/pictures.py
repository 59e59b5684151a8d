"""Couplings that read pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.element import Arrays, Coupling, PortAxes, PortBounds, Setting
from deodar.leaves import is_neutral
from deodar.numerics import homography
from deodar.numerics.axes import Axis, shape, wrong_shape
from deodar.numerics.colors import CHANNELS, cells, from_hues, hue_saturation_value, same_side
from deodar.numerics.convolution import along
from deodar.numerics.resampling import INTERPOLATIONS
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class ColorSpace(Coupling):
    r"""A space code of a picture over position and hue, with the saturation as amplitude.

    H(p) and S(p) are hue and saturation of pixel p; S counts as 0 where the value is below `darkest`. For
    sigma = 0, w is a density of integral 1, which divides S between the two nearest samples.

    Equation:
        y(x, \mathrm{hue}) = \operatorname{mean}_{p \in \mathrm{cell}(x)} S(p)\, w(\mathrm{hue} -
            H(p))
        w(d) = \exp\!\left( -\frac{d^2}{2 \sigma^2} \right)
        \sigma = 0\text{:}\quad w(d) = \frac{1}{\mathrm{step}} \max\!\left(0, 1 -
            \frac{|d|}{\mathrm{step}}\right)

    Parameters:
        axes: the picture's two dimensions, then hue; the dimensions may have fewer samples than the picture;
            hue is periodic.
        sigma: width of the code along hue; in units of the hue axis; 0: no smoothing (a hue is divided
            between its two nearest samples).
        darkest: value (largest channel, 0 to 1) below which a pixel does not count; its saturation is mostly
            noise.

    Ports:
        input: picture over the same two dimensions and a last axis of three samples, the channels red, green
            and blue, values 0 to 1.
        output: over `axes`; 0 to 1, for sigma = 0 per unit of the hue axis, 0 to 1 / step. Its integral over
            hue does not depend on the sampling of hue.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 11 and the smoothing after it.
        Hue and saturation: Smith (1978), Color gamut transform pairs, SIGGRAPH '78 (HSV).
    """

    axes: Sequence[Axis] = ()
    sigma: Annotated[float, Live("hue", lower=0, neutral=0.0, off=True)] = 0.0
    darkest: Annotated[float, Live(lower=0, upper=1)] = 0.15

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS or len(self.axes) != 3:
            yield "needs a picture (two dimensions and three channels) and gives two dimensions and hue"
            return
        if not self.axes[-1].periodic:
            yield f"the hue axis {self.axes[-1].name!r} must be periodic: red lies on both sides of its ends"
        for fine, coarse in zip(source[:2], self.axes[:2], strict=True):
            if not same_side(fine, coarse):
                yield (
                    f"axis {coarse.name!r} does not fit the picture's: {fine} there, {coarse} here (ends may"
                    " differ by a grid step)"
                )

    def prepare(self, at: Setting) -> list[Array]:
        return [cells(a, b, at.dtype) for a, b in zip(at.ins["input"][:2], self.axes[:2], strict=True)]

    def output(self, at: Setting) -> Arrays:
        hue_axis = self.axes[-1]
        turn, saturation, value = hue_saturation_value(at.inputs["input"])
        saturation = jnp.where(value < self.darkest, 0.0, saturation)
        distance = from_hues(hue_axis, turn, at.dtype)
        if is_neutral(self.sigma):
            code = jnp.maximum(0.0, 1.0 - jnp.abs(distance) / hue_axis.step) / hue_axis.step
        else:
            code = jnp.exp(-0.5 * (distance / self.sigma) ** 2)
        y = saturation[..., None] * code
        for d, weights in enumerate(at.constants):
            y = along(weights, y, d)
        return {"output": y}

    @classmethod
    def example(cls) -> ColorSpace:
        axes = [Axis("x", 0, 4, 3), Axis("y", 0, 4, 3), Axis("hue", 0, 360, 6, periodic=True)]
        return cls(axes, sigma=30.0, name="example")


@register
@dataclass(frozen=True)
class ColorHistogram(Coupling):
    r"""The histogram of hues in each column of a picture.

    A column in which all pixels have one hue gives 1 at that hue. n(x, h) is the share of the pixels of
    column x whose hue is h (each pixel is divided between the two nearest samples); pixels with a saturation
    below `palest` or a value below `darkest` are not counted.

    Equation:
        y(x, h) = \sum_j n(x, h_j) \exp\!\left( -\frac{(h - h_j)^2}{2 \sigma^2} \right)
        \sigma = 0\text{:}\quad y(x, h) = n(x, h)

    Parameters:
        axes: the dimension of the picture that remains, then hue; the dimension may have fewer samples than
            the picture; hue is periodic.
        sigma: width of the smoothing over hue; in units of the hue axis; 0: none.
        palest: saturation (0 to 1) below which a pixel is not counted.
        darkest: value (largest channel, 0 to 1) below which a pixel is not counted.

    Ports:
        input: picture over two dimensions and a last axis of three samples, the channels red, green and blue,
            values 0 to 1.
        output: over `axes`, 0 to 1 (with smoothing, contributions of several hues add up).

    Reference:
        Sandamirskaya & Schöner (2010), Serial order in an acting system, Neural Netw. 23, 1164-1179, figure 8
        and section 4. The paper states neither the limits, the smoothing nor the scale; deodar's values are
        guesses (the share per single bin reaches none of the paper's thresholds).
    """

    axes: Sequence[Axis] = ()
    sigma: Annotated[float, Live("hue", lower=0, neutral=0.0, off=True)] = 0.0
    palest: Annotated[float, Live(lower=0, upper=1)] = 0.3
    darkest: Annotated[float, Live(lower=0, upper=1)] = 0.15

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS or len(self.axes) != 2:
            yield (
                "needs a picture (two dimensions and three channels) and gives one of its dimensions and hue"
            )
            return
        kept, hue = self.axes
        if not hue.periodic:
            yield f"the hue axis {hue.name!r} must be periodic: red lies on both sides of its ends"
        side = next((a for a in source[:2] if a.name == kept.name), None)
        if side is None or not same_side(side, kept):
            found = side or " and ".join(a.name for a in source[:2])
            yield (
                f"axis {kept.name!r} does not fit the picture's: {found} there, {kept} here (ends may differ"
                " by a grid step)"
            )

    def prepare(self, at: Setting) -> Arrays:
        kept = self._kept(at)
        return {"cells": cells(at.ins["input"][kept], self.axes[0], at.dtype)}

    def hoist(self, at: Setting) -> Arrays:
        if is_neutral(self.sigma):
            return at.constants
        hue = self.axes[-1]
        turns = (at.points(hue) - hue.lower) / hue.range
        return at.constants | {"smooth": jnp.exp(-0.5 * (from_hues(hue, turns, at.dtype) / self.sigma) ** 2)}

    def jumps_at(self) -> Sequence[str]:
        return "input", "palest", "darkest"

    def output(self, at: Setting) -> Arrays:
        hue = self.axes[-1]
        turn, saturation, value = hue_saturation_value(at.inputs["input"])
        coloured = (saturation >= self.palest) & (value >= self.darkest) & (saturation > 0)
        if self._kept(at) == 1:
            turn, coloured = turn.T, coloured.T
        counted = coloured / jnp.asarray(turn.shape[1], at.dtype)

        def add(line: Array, y: Array) -> Array:
            # one line at a time: an array of all pixels and hues would take ten times as long
            shares = jnp.maximum(0.0, 1.0 - jnp.abs(from_hues(hue, turn[:, line], at.dtype)) / hue.step)
            return y + counted[:, line, None] * shares

        y = lax.fori_loop(0, turn.shape[1], add, jnp.zeros((turn.shape[0], hue.samples), at.dtype))
        y = along(at.constants["cells"], y, 0)
        return {"output": along(at.constants["smooth"], y, 1) if "smooth" in at.constants else y}

    def _kept(self, at: Setting) -> int:
        """The index of the picture's dimension that remains."""
        return [a.name for a in at.ins["input"][:2]].index(self.axes[0].name)

    @classmethod
    def example(cls) -> ColorHistogram:
        return cls([Axis("x", 0, 4, 3), Axis("hue", 0, 360, 6, periodic=True)], sigma=30.0, name="example")


TURN = 360.0
"""Degrees of all hues."""


@register
@dataclass(frozen=True)
class HueSaturationValue(Coupling):
    r"""The hue, saturation and value of each pixel in place of its red, green and blue.

    A grey pixel has the hue 0.

    Equation:
        v = \max(r, g, b),\quad c = v - \min(r, g, b),\quad s = c / v
        h = 60 \cdot \begin{cases} (g - b) / c \bmod 6 & v = r \\ (b - r) / c + 2 & v = g \\
            (r - g) / c + 4 & v = b \end{cases}

    Parameters:
        none.

    Ports:
        input: picture over two dimensions and a last axis of three samples, the channels red, green and blue,
            values 0 to 1.
        output: over the same axes; along the last one hue (0 to 360 degrees, red 0), saturation and value (0
            to 1).

    Reference:
        Smith (1978), Color gamut transform pairs, Comput. Graph. (SIGGRAPH) 12, 12-19.
    """

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        source = ins["input"]
        if len(source) != 3 or source[-1].samples != CHANNELS:
            yield "needs a picture: two dimensions, and a last axis with the channels red, green and blue"

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": (min(0.0, inputs["input"][0]), max(TURN, inputs["input"][1]))}

    def output(self, at: Setting) -> Arrays:
        hue, saturation, value = hue_saturation_value(at.inputs["input"])
        return {"output": jnp.stack([TURN * hue, saturation, value], axis=-1)}


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
        picture: the four points in the picture; on its first and second axis, in the units of these axes; no
            three on one line.
        plane: the same four points in the plane; in the units of `axes`, in the same order.
        interpolation: nearest pixel, or the four around; `nearest` (the value of one pixel, so that no
            colours are mixed) or `linear` (of the four pixels around).

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

    axes: Sequence[Axis] = ()
    picture: Annotated[ArrayLike, Rebuild()] = CORNERS
    plane: Annotated[ArrayLike, Rebuild()] = CORNERS
    interpolation: Annotated[str, Recompile(choices=INTERPOLATIONS)] = "nearest"

    linear: ClassVar[bool] = True

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": (*self.axes, *ins["input"][2:])}

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        if len(self.axes) != 2 or len(ins["input"]) < 2:
            yield (
                f"maps a picture of two dimensions onto a plane of two; it has {len(self.axes)} axes, and its"
                f" input {len(ins['input'])}",
                "Give it two axes, and a picture over columns and rows",
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

    def output(self, at: Setting) -> Arrays:
        picture, position = at.inputs["input"], at.constants["samples"]
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
