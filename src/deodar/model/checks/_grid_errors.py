"""The error that a grid makes in the thresholds of a field, from a stored table.

The table holds the error of the boost that erases a memory, the threshold that depends most on the grid, as
`python benchmarks/resolution.py edges` prints it: for a resting level of -5, and for the worse of a peak on a
sample and one between two.

A field is compared with it by two numbers without a unit: beta times the distance of its resting level from
the threshold, which says how steep its sigmoid is, and the change of beta times activation from sample to
sample at the edge of a peak, which says how coarse its grid is.
"""

from __future__ import annotations

import functools
import math
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path

import numpy as np

TABLE = Path(__file__).with_name("grid_errors.csv")
QUADRATURES = ("point", "cell")
REST, STEEPEST = 5.0, 100.0
"""Distance of the resting level from the threshold, and the largest beta, in the fields of the table."""
MOST_AXES = 2
"""Most axes of a field of the table. More were not measured; they count as two."""

Curve = tuple[np.ndarray, np.ndarray]
"""Logarithms of the change at the edge, rising, and of the error in percent."""


def percent(quadrature: str, axes: int, steepness: float, edge: float) -> float:
    """Return the probable error of thresholds in percent; between rows of the table interpolated.

    Args:
        quadrature: `point` or `cell`.
        axes: number of axes of the field.
        steepness: beta times the distance of the resting level from the threshold.
        edge: the change of beta times activation from sample to sample at the edge of a peak.
    """
    curves = _curves()[quadrature, min(axes, MOST_AXES)]
    betas = np.array(sorted(curves))
    beta = float(np.clip(steepness / REST, betas[0], betas[-1]))
    errors = [_at(curves[b], math.log(min(max(edge, 1e-9), 1e9))) for b in betas]
    return math.exp(float(np.interp(math.log(beta), np.log(betas), errors)))


def largest_edge(quadrature: str, axes: int, steepness: float, most: float) -> float:
    """Return the largest change at the edge of a peak with which the error is below a percentage; 0 if it is
    above on all grids of the table.
    """
    low, high = -3.0, 9.0  # logarithms
    if percent(quadrature, axes, steepness, math.exp(low)) > most:
        return 0.0
    for _ in range(40):
        middle = (low + high) / 2
        exceeded = percent(quadrature, axes, steepness, math.exp(middle)) > most
        low, high = (low, middle) if exceeded else (middle, high)
    return math.exp(low)


def _at(curve: Curve, edge: float) -> float:
    """Return the logarithm of an error. Beyond the finest grid of the table it falls with the step or faster,
    beyond the coarsest it stays.
    """
    edges, errors = curve
    return float(np.interp(edge, edges, errors)) + min(0.0, edge - float(edges[0]))


@functools.cache
def _curves() -> Mapping[tuple[str, int], Mapping[float, Curve]]:
    import csv  # start-up time: only a field with peaks needs it

    rows: dict[tuple[str, int], dict[float, list[tuple[float, float]]]] = defaultdict(
        lambda: defaultdict(list)
    )
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for quadrature in QUADRATURES:
                pair = math.log(float(row["edge"])), math.log(float(row[quadrature]))
                rows[quadrature, int(row["axes"])][float(row["beta"])].append(pair)
    return {
        key: {beta: (*np.array(sorted(pairs)).T,) for beta, pairs in by_beta.items()}
        for key, by_beta in rows.items()
    }
