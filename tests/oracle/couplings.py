"""Couplings as plain functions of arrays, position by position."""

from __future__ import annotations

import colorsys
import math

import numpy as np

from tests.oracle.kernels import each, grid


def interpolated(y, axis, points, d, how="linear"):
    """Return the values of y at other points of axis d; zeros follow the last sample if the axis is not
    periodic.
    """
    step = grid(axis)[1]
    y = np.moveaxis(y, d, 0)

    def sample(k):
        if axis.periodic:
            return y[k % axis.samples]
        return y[k] if 0 <= k < axis.samples else np.zeros(y.shape[1:])

    out = []
    for p in points:
        place = round((p - axis.lower) / step, 12)
        below = math.floor(place)
        share = place - below
        if how == "nearest":
            out.append(sample(below if share < 0.5 else below + 1))
        else:
            out.append((1 - share) * sample(below) + share * sample(below + 1))
    return np.moveaxis(np.array(out), 0, d)


def resample(y, source, target, how="linear"):
    for d, (a, b) in enumerate(zip(source, target, strict=True)):
        y = interpolated(y, a, grid(b)[0], d, how)
    return y


def shift(y, axes, amount):
    for d, a in enumerate(axes):
        y = interpolated(y, a, grid(a)[0] - each(amount, d), d)
    return y


def project(y, source, p):
    """Contract, resample, reorder, expand: axes by their names after renaming."""
    names = [dict(p.rename).get(a.name, a.name) for a in source]
    expected = {a.name: a for a in p.axes}
    axes = list(source)
    for d in range(len(names) - 1, -1, -1):
        if names[d] not in expected:
            step = grid(axes[d])[1]
            reductions = {
                "integral": lambda v, d, h=step: h * v.sum(d),
                "sum": np.sum,
                "mean": np.mean,
                "max": np.max,
                "min": np.min,
            }
            y = reductions[p.reduce](y, d)
            del names[d], axes[d]
    for d, name in enumerate(names):
        if expected[name].samples != axes[d].samples:
            y = interpolated(y, axes[d], grid(expected[name])[0], d, p.interpolation)
    out = np.zeros(tuple(a.samples for a in p.axes))
    for place in np.ndindex(*out.shape):
        by_name = dict(zip((a.name for a in p.axes), place, strict=True))
        out[place] = y[tuple(by_name[n] for n in names)]
    return out


def weights(y, source, target, w):
    """Return the weighted sum over all positions of the source, times the volume of a cell."""
    out = np.zeros(tuple(a.samples for a in target))
    for place in np.ndindex(*out.shape):
        out[place] = (w[place] * y).sum() * math.prod(grid(a)[1] for a in source)
    return out


def threshold(y, level):
    return np.where(y > level, y, 0.0)


def peak_position(f, p):
    """Return position and strength."""
    x, step = grid(p.axis)
    n = f.sum() * step
    if n <= p.least:
        return p.absent, n
    if not p.axis.periodic:
        return (x * f).sum() * step / n, n
    period = p.axis.upper - p.axis.lower
    direction = sum(
        fi * np.exp(2j * math.pi * (xi - p.axis.lower) / period) for xi, fi in zip(x, f, strict=True)
    )
    return p.axis.lower + (np.angle(direction) % (2 * math.pi)) * period / (2 * math.pi), n


def color_space(picture, source, p):
    """Each pixel votes for its hue with its saturation; a cell holds the mean over its pixels."""
    hue_axis = p.axes[2]
    hues, step = grid(hue_axis)
    period = hue_axis.upper - hue_axis.lower
    votes = np.zeros((*picture.shape[:2], hue_axis.samples))
    for i, j in np.ndindex(*picture.shape[:2]):
        h, s, v = colorsys.rgb_to_hsv(*picture[i, j])
        if v < p.darkest:
            continue
        for k, hue in enumerate(hues):
            away = min(abs(hue - hue_axis.lower - h * period + m * period) for m in (-1, 0, 1))
            votes[i, j, k] = s * (
                math.exp(-(away**2) / (2 * p.sigma**2)) if p.sigma else max(0.0, 1 - away / step) / step
            )
    out = np.zeros(tuple(a.samples for a in p.axes))
    x, y = [_members(a, b) for a, b in zip(source[:2], p.axes[:2], strict=True)]
    for i, j in np.ndindex(*out.shape[:2]):
        pixels = [votes[a, b] for a in x[i] for b in y[j]]
        out[i, j] = np.mean(pixels, axis=0)
    return out


def _members(fine, coarse):
    """Return the fine samples of each coarse cell, or the nearest sample if a cell has none."""
    x, (y, step) = grid(fine)[0], grid(coarse)
    out = []
    for place in y:
        inside = [i for i, xi in enumerate(x) if -0.5 <= round((xi - place) / step, 12) < 0.5]
        # the upper of two samples at the same distance
        nearest = max(range(len(x)), key=lambda i: (-round(abs(x[i] - place), 12), i))
        out.append(inside or [nearest])
    return out
