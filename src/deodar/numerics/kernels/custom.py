"""The kernel defined by an array."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import DTypeLike

from deodar.leaves import per_axis
from deodar.numerics import resampling
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.convolution import along
from deodar.numerics.intervals import ANY, Interval, hull, signed
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.signs import Sign, product, sign_of
from deodar.parameters import ArrayLike, FrozenArray, Live, PerAxis, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Custom(Kernel):
    r"""A kernel defined by an array around distance zero, symmetric or not.

    The array has one axis for each axis of the field. Weights are interpolated linearly between its samples
    and 0 beyond them.

    Equation:
        k(d) = \mathrm{amplitude} \cdot \mathrm{weights}\!\left[\mathrm{centre} +
            \frac{d}{\mathrm{spacing}}\right]

    Parameters:
        weights: array with an odd number of samples on every axis; its middle is distance zero; per unit of
            the axes.
        amplitude: factor.
        spacing: distance of neighbouring samples; in axis units, one value or one for each axis; none: the
            field's grid step (the kernel then changes with the grid).
        boundary: what lies beyond the border; `periodic`, `zero`, `reflect` or `replicate`, one value or one
            for each axis; none: `periodic` on periodic axes, `zero` on others.

    Shapes:
        weights: one odd number of samples for each axis of the field.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (k, without an assumption on
        its form).
    """

    weights: Annotated[ArrayLike, Rebuild("activation")] = FrozenArray([0.25, 0.5, 0.25])
    amplitude: Annotated[float, Live()] = 1.0
    spacing: Annotated[PerAxis | None, Recompile("axis", lower=1e-9)] = None

    def bounds(self, axes: Axes) -> Interval:
        if self.spacing is not None or not isinstance(self.weights, FrozenArray):
            return ANY
        up, down = (
            float(part.sum()) * cell(axes)
            for part in (np.maximum(self.weights.data, 0), np.minimum(self.weights.data, 0))
        )
        return hull(signed(self.amplitude * up), signed(self.amplitude * down))

    def polarity(self) -> Sign:
        return product(sign_of(self.weights), sign_of(self.amplitude))

    def samples(self, axes: Axes, dtype: DTypeLike) -> Array:
        table = self.weights.data if isinstance(self.weights, FrozenArray) else self.weights
        weights = jnp.asarray(table, dtype)
        if self.spacing is None:
            return weights
        for d, (axis, spacing) in enumerate(zip(axes, per_axis(self.spacing, axes), strict=True)):
            half = spacing * (weights.shape[d] - 1) / 2
            if half == 0:
                continue
            reach = int(np.floor(half / axis.step + 1e-9))  # weights beyond the last sample are 0
            points = axis.step * np.arange(-reach, reach + 1)
            grid = Axis("lag", -half, half, weights.shape[d])
            weights = along(resampling.weights(grid, points, "linear", dtype), weights, d)
        return weights

    def validate_axes(self, axes: Axes) -> Iterator[str]:
        yield from super().validate_axes(axes)
        if isinstance(self.spacing, tuple) and len(self.spacing) != len(axes):
            yield f"spacing has {len(self.spacing)} values for {len(axes)} axes"
        shape = self.weights.shape if isinstance(self.weights, FrozenArray) else ()
        if axes and len(shape) != len(axes):
            yield f"weights has {len(shape)} axes, the field {len(axes)}"
        elif any(n % 2 == 0 for n in shape):
            yield f"weights has an even number of samples ({list(shape)}); its middle must be distance zero"
