"""Interaction kernels as direct sums: one weight for every pair of samples, with explicit images of the
source.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from scipy.interpolate import RegularGridInterpolator


def each(value, d):
    """Return the value for axis d; one number is that of all axes."""
    return value[d] if isinstance(value, tuple) else value


def gaussian(lags, steps, amplitude, sigma, normalized):
    weight = amplitude
    for d, (lag, step) in enumerate(zip(lags, steps, strict=True)):
        s = each(sigma, d)
        weight = weight * np.exp(-(lag**2) / (2 * s**2))
        reach = math.ceil(12 * s / step) + 1
        summed = step * sum(math.exp(-((k * step) ** 2) / (2 * s**2)) for k in range(-reach, reach + 1))
        if normalized:  # the integral on the grid: the sum over an infinite grid times its step
            weight = weight / summed
        # the grid does not resolve the kernel: its integral is kept, not its value at the centre
        elif s < step:
            weight = weight * math.sqrt(2 * math.pi) * s / summed
    return weight


def box(lags, steps, amplitude, width, normalized):
    weight = amplitude
    for d, (lag, step) in enumerate(zip(lags, steps, strict=True)):
        w = each(width, d)
        left, right = np.maximum(lag - step / 2, -w / 2), np.minimum(lag + step / 2, w / 2)
        share = np.where(right > left, (right - left) / step, 0.0)
        weight = weight * (share / w if normalized else share)
    return weight


def custom(lags, steps, kernel):
    weights = kernel.weights.data
    spacing = steps if kernel.spacing is None else [each(kernel.spacing, d) for d in range(len(steps))]
    grids = [np.arange(n) - (n - 1) // 2 for n in weights.shape]
    places = np.stack(
        [np.round(lag / s, 12) for lag, s in zip(np.broadcast_arrays(*lags), spacing, strict=True)], axis=-1
    )
    # the neighbours of the only sample of a grid are itself
    padded, wide = weights, []
    for d, grid in enumerate(grids):
        if len(grid) == 1:
            pad = [(0, 0)] * weights.ndim
            pad[d] = (1, 1)
            padded, grid = np.pad(padded, pad), np.arange(-1, 2)
        wide.append(grid)
    return kernel.amplitude * RegularGridInterpolator(wide, padded, bounds_error=False, fill_value=0.0)(
        places
    )


def weight(kernel, lags, steps):
    """Return k at the given lags (one array for each axis), without a boundary."""
    match type(kernel).__name__:
        case "Gaussian":
            return gaussian(lags, steps, kernel.amplitude, kernel.sigma, kernel.normalized)
        case "Box":
            return box(lags, steps, kernel.amplitude, kernel.width, kernel.normalized)
        case "MexicanHat":
            up = gaussian(lags, steps, kernel.excitation, kernel.sigma_excitation, kernel.normalized)
            return up - gaussian(lags, steps, kernel.inhibition, kernel.sigma_inhibition, kernel.normalized)
        case "Shifted":
            return weight(kernel.kernel, [lag - each(kernel.shift, d) for d, lag in enumerate(lags)], steps)
        case "Custom":
            return custom(lags, steps, kernel)
    raise NotImplementedError(type(kernel).__name__)


def boundaries(kernel, axes):
    if kernel.boundary is None:
        return ["periodic" if a.periodic else "zero" for a in axes]
    return list(kernel.boundary) * (len(axes) if len(kernel.boundary) == 1 else 1)


def grid(axis):
    """Return the samples of an axis and their distance."""
    step = (axis.upper - axis.lower) / (axis.samples if axis.periodic else axis.samples - 1)
    return np.array([axis.lower + i * step for i in range(axis.samples)]), step


def images(axis, boundary, many):
    """Return the positions of the images of all samples of an axis: arrays of the axis's length."""
    x, step = grid(axis)
    if boundary == "zero":
        return [x]
    period = step * axis.samples
    if boundary == "periodic":
        return [x + m * period for m in range(-many, many + 1)]
    mirror = 2 * (axis.lower - step / 2) - x  # at the outer edge of the first cell
    return [y + 2 * m * period for m in range(-many, many + 1) for y in (x, mirror)]


def dense(kernels, axes, many=12):
    """Return all weights between pairs of positions, times the volume of a cell: a matrix (positions,
    positions).
    """
    shape = tuple(a.samples for a in axes)
    n = int(np.prod(shape))
    if not axes:
        return np.array([[sum(self_excitation(k) for k in kernels)]], float)
    steps = [grid(a)[1] for a in axes]
    here = np.meshgrid(*(grid(a)[0] for a in axes), indexing="ij")
    total = np.zeros((n, n))
    for kernel in kernels:
        seen = [images(a, b, many) for a, b in zip(axes, boundaries(kernel, axes), strict=True)]
        for combination in itertools.product(*seen):
            there = np.meshgrid(*combination, indexing="ij")
            lags = [a.reshape(n, 1) - b.reshape(1, n) for a, b in zip(here, there, strict=True)]
            total += weight(kernel, lags, steps)
    return total * math.prod(steps)


def self_excitation(kernel):
    """Return the self-excitation of a node: the amplitude of its kernel."""
    match type(kernel).__name__:
        case "MexicanHat":
            return kernel.excitation - kernel.inhibition
        case "Shifted":
            return self_excitation(kernel.kernel)
    return kernel.amplitude
