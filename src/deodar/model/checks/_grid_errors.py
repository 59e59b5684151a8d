"""The error that a grid makes in the thresholds of a field, from a stored table.

The table holds the error of the boost that erases a memory, the threshold that depends most on the grid, as
`python benchmarks/resolution.py edges` prints it: for a resting level of -5, and for the worse of a peak on a
sample and one between two.

A field is compared with it by its steepness, beta times the distance of its resting level from the threshold,
and by how coarse its grid is. For sums over points that is the change of beta times activation from sample to
sample at the edge of a peak, which decides how far the edge is resolved; for means over cells it is the step
in widths of the kernel.
"""

from __future__ import annotations

import functools
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

TABLE = Path(__file__).with_name("grid_errors.csv")
QUADRATURES = ("point", "cell")
REST, STEEPEST = 5.0, 100.0
"""Distance of the resting level from the threshold, and the largest beta, in the fields of the table."""
MOST_AXES = 2
"""Most axes of a field of the table. More were not measured; they count as two."""

Curve = tuple[np.ndarray, np.ndarray]
"""Logarithms of how coarse grids are and of the error in percent, both rising."""


def percent(quadrature: str, axes: int, steepness: float, coarseness: float) -> float:
    """Return the probable error of thresholds in percent; between rows of the table interpolated.

    Args:
        quadrature: `point` or `cell`.
        axes: number of axes of the field.
        steepness: beta times the distance of the resting level from the threshold.
        coarseness: for `point` the change of beta times activation from sample to sample at the edge of a
            peak, for `cell` the step in widths of the kernel.
    """
    curves = _curves()[quadrature, min(axes, MOST_AXES)]
    betas = np.array(sorted(curves))
    beta = float(np.clip(steepness / REST, betas[0], betas[-1]))
    errors = [_at(curves[b], math.log(min(max(coarseness, 1e-9), 1e9))) for b in betas]
    return math.exp(float(np.interp(math.log(beta), np.log(betas), errors)))


def coarsest(quadrature: str, axes: int, steepness: float, most: float) -> float:
    """Return the largest coarseness with which the error is at most a percentage."""
    low, high = math.log(1e-9), math.log(1e3)
    for _ in range(60):
        middle = (low + high) / 2
        exceeded = percent(quadrature, axes, steepness, math.exp(middle)) > most
        low, high = (low, middle) if exceeded else (middle, high)
    return math.exp(low)


def _at(curve: Curve, coarseness: float) -> float:
    """Return the logarithm of an error. Beyond the finest grid of the table it falls with the step or faster,
    beyond the coarsest it grows with its square.
    """
    grids, errors = curve
    inside = float(np.interp(coarseness, grids, errors))
    return inside + min(0.0, coarseness - float(grids[0])) + 2 * max(0.0, coarseness - float(grids[-1]))


@functools.cache
def _curves() -> Mapping[tuple[str, int], Mapping[float, Curve]]:
    import csv  # start-up time: only a field with peaks needs it

    rows: dict[tuple[str, int], dict[float, list[tuple[float, float]]]] = defaultdict(
        lambda: defaultdict(list)
    )
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for quadrature in QUADRATURES:
                beta = float(row["beta"])
                coarseness = (
                    float(row["edge"]) if quadrature == "point" else 1 / float(row["samples_a_width"])
                )
                pair = math.log(coarseness), math.log(float(row[quadrature]))
                rows[quadrature, int(row["axes"])][beta].append(pair)
    return {key: {beta: _curve(pairs) for beta, pairs in by_beta.items()} for key, by_beta in rows.items()}


def _curve(pairs: Sequence[tuple[float, float]]) -> Curve:
    """Return grids and errors; a finer grid may be worse by chance, so that errors count as rising."""
    grids, errors = np.array(sorted(pairs)).T
    return grids, np.maximum.accumulate(errors)
