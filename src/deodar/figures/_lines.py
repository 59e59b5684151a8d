"""Curves of trials and sweep points: thin lines, their mean, a line at the threshold."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import matplotlib
import numpy as np
import xarray
from matplotlib.axes import Axes

from deodar.errors import RecordError, option
from deodar.figures import _style
from deodar.figures._view import TRIAL, View, values

MOST_TRIALS = 50
"""Most trials drawn as single lines; the mean is that of all trials."""

MOST_CURVES = 12
LEVEL = "_threshold"
"""Label of the line at the threshold, which no legend shows."""


def curves(
    ax: Axes,
    v: xarray.DataArray,
    x: np.ndarray,
    across: str,
    view: View,
    labels: dict[str, Any] | None = None,
    read: ReadPart | None = None,
) -> None:
    """Draw one curve over the dimension `across` for each remaining point of `v`; trials are thin lines with
    their mean.

    `labels` names the points of dimensions that are neither trial nor `across` (positions in a field). `read`
    returns a part of the values, with `across` as the last axis and trials before it; None: those of `v`.
    """
    others = [str(d) for d in v.dims if d not in (TRIAL, across)]
    grid = tuple(v.sizes[d] for d in others)
    if int(np.prod(grid)) > MOST_CURVES:
        raise RecordError(
            f"would need {int(np.prod(grid))} curves; a figure shows at most {MOST_CURVES}",
            where=view.name,
            fix=option("Choose values:", "where", "PATH=VALUE", "{PATH: value}"),
        )
    many = TRIAL in v.dims and v.sizes[TRIAL] > 1
    ordered = v.transpose(*others, *([TRIAL] if TRIAL in v.dims else []), across)
    reading = read or (lambda part: values(ordered[..., part]))
    x, flat, mean = reduced(reading, x, view.variable.nbytes / len(x), many)
    colors = _colors(v, others, grid, view.name)
    marker: dict[str, Any] = {"marker": "o", "markersize": 3.5, "linestyle": "none"} if len(x) == 1 else {}
    for k, point in enumerate(np.ndindex(*grid)):
        rows, label = flat[point].reshape(-1, len(x)), _label(v, others, point, labels)
        if mean is not None:
            thin: dict[str, Any] = {
                "alpha": min(0.5, max(0.12, 4 / len(rows))),
                "linewidth": _style.THIN,
            }
            for row in rows[:MOST_TRIALS]:
                ax.plot(x, row, color=colors[k], **(thin | marker))
            rows = mean[point].reshape(-1, len(x))
        ax.plot(
            x,
            rows[0],
            color=colors[k],
            label=label or (f"mean of {v.sizes[TRIAL]} trials" if many else None),
            **marker,
        )
    level(ax, view)
    limits(ax, view)
    if many or any(grid_size > 1 for grid_size in grid):
        ax.legend(loc="best", frameon=True, framealpha=0.8, edgecolor="none")


def rows(v: xarray.DataArray, across: str) -> list[np.ndarray]:
    """Return the values of the lines that `curves` draws, in their order."""
    others = [str(d) for d in v.dims if d not in (TRIAL, across)]
    ordered = values(v.transpose(*others, *([TRIAL] if TRIAL in v.dims else []), across))
    x = np.arange(v.sizes[across])
    many = TRIAL in v.dims and v.sizes[TRIAL] > 1
    _, flat, mean = reduced(lambda part: ordered[..., part], x, v.nbytes / len(x), many)
    out: list[np.ndarray] = []
    for point in np.ndindex(*(v.sizes[d] for d in others)):
        lines = flat[point].reshape(-1, flat.shape[-1])
        out += list(lines[:MOST_TRIALS]) if mean is not None else [lines[0]]
        out += [] if mean is None else [mean[point].reshape(-1)]
    return out


def level(ax: Axes, view: View) -> None:
    """Draw a line at the threshold, if the variable has one and its values come near it."""
    if view.threshold is not None:
        ax.axhline(view.threshold, label=LEVEL, **_style.THRESHOLD_LINE)


def limits(ax: Axes, view: View) -> None:
    """Set the range of the values, if the view selects one."""
    if view.value_range is not None:
        ax.set_ylim(*view.value_range)


def _colors(v: xarray.DataArray, others: list[str], grid: tuple[int, ...], name: str) -> list[Any]:
    """Return colours: that of the port for a single line, ordered ones for values of one dimension, distinct
    ones for positions and mixtures.
    """
    n = int(np.prod(grid))
    if n == 1:
        return [_style.port_color(name)]
    if len(others) == 1 and n > 2 and v[others[0]].dtype.kind in "iuf" and others[0] in v.coords:
        return list(matplotlib.colormaps[_style.ORDERED](np.linspace(0.0, 0.85, n)))
    return [_style.COLORS[k % len(_style.COLORS)] for k in range(n)]


def _label(
    v: xarray.DataArray, others: list[str], point: tuple[int, ...], labels: dict[str, Any] | None
) -> str:
    parts: list[str] = []
    for dim, k in zip(others, point, strict=True):
        if labels and dim in labels:
            parts.append(labels[dim][k])
        elif v.sizes[dim] > 1:
            parts.append(f"{dim} = {v[dim].values[k]:g}")
    return ", ".join(p for p in parts if p)


# ----------------------------------------------------------------------------------------------- long courses


MOST_SAMPLES = 4000
"""Most samples of a drawn line: two for each of 2000 intervals, which are narrower than the dots of a printer
across two columns of a journal (183 mm at 300 dots per inch: 2161).
"""

BLOCK = 2**26
"""Number of bytes that are read at a time."""

ReadPart = Callable[[slice], np.ndarray]
"""Returns a part of the samples, which are the last axis."""


def reduced(
    read: ReadPart, x: np.ndarray, bytes_each: float, trials: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return positions, values, and the mean over trials; of at most `MOST_SAMPLES` samples.

    A longer course is divided into intervals. Each is drawn by its smallest and its largest value, in the
    order in which its first and its last value suggest, so no extreme value is left out.

    Args:
        read: reads a part of the samples.
        x: the position of each sample.
        bytes_each: number of bytes that are read for one sample.
        trials: whether the last axis but one is that of trials, whose mean is also returned.
    """
    n = len(x)
    if n <= MOST_SAMPLES:
        values = read(slice(0, n))
        return x, values, _mean(values) if trials else None
    edges = np.linspace(0, n, MOST_SAMPLES // 2 + 1).astype(np.int64)
    at_once = max(1, int(BLOCK / max(bytes_each, 1e-9) / (n / (len(edges) - 1))))
    rows: list[np.ndarray] = []
    means: list[np.ndarray] = []
    for first in range(0, len(edges) - 1, at_once):
        own = edges[first : first + at_once + 1]
        values = read(slice(int(own[0]), int(own[-1])))
        rows.append(_extremes(values, own - own[0]))
        if trials:
            means.append(_extremes(_mean(values), own - own[0]))
    middle = (edges[:-1] + edges[1:]) // 2
    where = np.stack([x[edges[:-1]], x[middle]], -1).reshape(-1)
    return where, np.concatenate(rows, -1), np.concatenate(means, -1) if trials else None


def _extremes(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return two values for each interval: the smallest and the largest one; NaN counts only where alone."""
    low = np.fmin.reduceat(values, edges[:-1], axis=-1)
    high = np.fmax.reduceat(values, edges[:-1], axis=-1)
    falls = values[..., edges[:-1]] > values[..., edges[1:] - 1]
    pair = np.stack([np.where(falls, high, low), np.where(falls, low, high)], -1)
    return pair.reshape(*pair.shape[:-2], -1)


def _mean(values: np.ndarray) -> np.ndarray:
    return values.mean(-2, keepdims=True, dtype=float)
