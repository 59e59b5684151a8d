"""The shape of interaction kernels over the lag between two positions, for plots."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from deodar.numerics.axes import Axes, Axis
from deodar.numerics.convolution import boundaries
from deodar.numerics.kernels._base import Kernel, sampled, samples_amplitude


def lag_axis(axis: Axis) -> Axis:
    """Return the axis of the lags between samples of an axis: from -range to range, on a periodic axis half
    as far.
    """
    reach = axis.step * (axis.samples // 2 if axis.periodic else axis.samples - 1)
    count = 2 * (axis.samples // 2) + 1 if axis.periodic else 2 * axis.samples - 1
    return Axis(f"lag in {axis.name}", -reach, reach, samples=max(2, count), unit=axis.unit)


def kernel_shape(kernels: Sequence[Kernel], axes: Axes) -> tuple[Axes, np.ndarray]:
    r"""Return the sum of kernels over the lags, at lag 0 on axes after the first two.

    Equation:
        k(d) = \sum_i k_i(d)

    Returns:
        The axes of the lags, and the weights, one for each combination of lags, per unit of the axes.
    """
    lag_axes = tuple(lag_axis(a) for a in axes[:2])
    lags = [a.points for a in lag_axes] + [np.zeros(1)] * len(axes[2:])
    total = np.zeros([len(lag) for lag in lags])
    for kernel in kernels:
        array = sampled(kernel, axes, np.float32)
        if array is None:
            total += _separable(kernel, axes, lags)
        else:
            total += np.asarray(samples_amplitude(kernel)) * _cut(np.asarray(array), lags)
    return lag_axes, total.reshape([a.samples for a in lag_axes])


def _separable(kernel: Kernel, axes: Axes, lags: Sequence[np.ndarray]) -> np.ndarray:
    bounds = boundaries(kernel.boundary, axes)
    total = np.zeros([len(lag) for lag in lags])
    for term in kernel.terms():
        part = np.asarray(term.amplitude, float)
        for d, (axis, lag) in enumerate(zip(axes, lags, strict=True)):
            period = axis.step * axis.samples if bounds[d] == "periodic" else None
            part = np.multiply.outer(part, np.asarray(term.along(d, jnp.asarray(lag), period, axis.step)))
        total += part
    return total


def _cut(weights: np.ndarray, lags: Sequence[np.ndarray]) -> np.ndarray:
    """Return an array around lag 0, cut or filled with 0 to the number of lags."""
    for d, lag in enumerate(lags):
        spare = (weights.shape[d] - len(lag)) // 2
        weights = (
            weights.take(np.arange(spare, spare + len(lag)), axis=d)
            if spare >= 0
            else np.pad(weights, [(-spare, -spare) if k == d else (0, 0) for k in range(weights.ndim)])
        )
    return weights
