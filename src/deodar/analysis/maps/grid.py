"""Grids from coarse to fine: which cells of a map are computed, and which are filled."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

COARSE = 8
"""Cells between two samples of the coarsest grid."""

Compute = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A function of the labels so far and of the numbers of cells, which returns the labels with theirs."""


def refined(shape: tuple[int, int], compute: Compute) -> tuple[np.ndarray, np.ndarray]:
    """Return the labels of a grid, of which only cells are computed that have a neighbour of another label.

    A grid with every eighth row and column comes first, then those with every fourth, second and each. On
    each, a new cell has the label of the cell before it, until one of its eight neighbours differs. A region
    is found if it contains a cell of the first grid, or touches the border of a region that is found.

    Args:
        shape: rows and columns.
        compute: computes labels.

    Returns:
        The labels, and whether each was computed.
    """
    labels, computed = np.zeros(shape, np.uint8), np.zeros(shape, bool)

    def add(places: tuple[np.ndarray, ...]) -> None:
        nonlocal labels
        cells = np.sort(np.ravel_multi_index(places, shape))
        labels = np.array(compute(labels.ravel(), cells)).reshape(shape)
        computed.reshape(-1)[cells] = True

    before = [np.arange(0)] * 2
    for level in _levels(shape):
        grid = np.ix_(*level)
        if not len(before[0]):
            add(np.nonzero(_mask(shape, grid)))
        else:
            # the nearest cell of the last grid that is not beyond
            pairs = zip(before, level, strict=True)
            place = [old[np.searchsorted(old, new, side="right") - 1] for old, new in pairs]
            labels[grid] = np.where(computed[grid], labels[grid], labels[np.ix_(*place)])
        while (todo := _differing(labels[grid]) & ~computed[grid]).any():
            rows, columns = np.nonzero(todo)
            add((level[0][rows], level[1][columns]))
        before = list(level)
    return labels, computed


def every(shape: tuple[int, int], compute: Compute) -> tuple[np.ndarray, np.ndarray]:
    """Return the labels of a grid of which every cell is computed, and that each was."""
    labels = np.asarray(compute(np.zeros(shape, np.uint8).ravel(), np.arange(shape[0] * shape[1])))
    return labels.reshape(shape), np.ones(shape, bool)


def _levels(shape: tuple[int, int]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield rows and columns of each grid, the coarsest first; all contain the first and the last."""
    stride = COARSE
    while stride:
        rows, columns = (np.unique([*range(0, n, stride), n - 1]) for n in shape)
        yield rows, columns
        stride //= 2


def _mask(shape: tuple[int, int], grid: tuple[np.ndarray, ...]) -> np.ndarray:
    mask = np.zeros(shape, bool)
    mask[grid] = True
    return mask


def _differing(labels: np.ndarray) -> np.ndarray:
    """Return which cells have a neighbour, also across a corner, of another label."""
    padded, out = np.pad(labels, 1, mode="edge"), np.zeros(labels.shape, bool)
    rows, columns = labels.shape
    for i in range(3):
        for j in range(3):
            out |= padded[i : i + rows, j : j + columns] != labels
    return out
