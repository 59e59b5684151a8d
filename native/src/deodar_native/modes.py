"""Tables of the spectral modes of a plane, in the form that the kernels read.

The modes of an axis are those of `deodar.numerics.waves.Waves`, with another origin of their phases: the
mirror of the axis, or of half a ring where frequencies are apart by parity. So every mode is symmetric or
antisymmetric. A kernel that is symmetric has the same gain for both modes of a frequency, so results do not
depend on the origin.
"""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Sequence
from typing import Protocol

import numpy as np

VECTOR = 16
"""Rows of tables of the inner axis are padded to this number of columns."""


class Modes(Protocol):
    """The modes of one axis.

    Attributes:
        boundary: `periodic`, `zero` or `reflect`.
        samples: number of samples of the axis.
        length: number of samples of the periodic axis.
        turns: the frequency of each mode; further entries of a frequency stand for no mode.
    """

    boundary: str
    samples: int
    length: int

    @property
    def turns(self) -> np.ndarray: ...


@dc.dataclass(frozen=True)
class AxisTables:
    """The tables of one axis, class after class.

    Attributes:
        forward, back: the modes at the samples that remain after folding, for both transforms.
        counts: number of modes in each class.
        places: where each mode is among those of deodar.
        total: number of modes of deodar.
    """

    forward: np.ndarray
    back: np.ndarray
    counts: np.ndarray
    places: np.ndarray
    total: int


def axis_tables(axis: Modes, outer: bool) -> AxisTables:
    """Return the tables of an axis of a plane."""
    key = (axis.boundary, axis.samples, axis.length, tuple(int(t) for t in axis.turns), outer)
    return _tables(*key)


@functools.lru_cache(maxsize=64)
def _tables(boundary: str, samples: int, length: int, turns: Sequence[int], outer: bool) -> AxisTables:
    parity = outer and boundary == "periodic" and samples % 2 == 0
    folded = samples // 2 if parity else samples
    kept, middle = (folded + 1) // 2, (folded - 1) / 2
    found: list[list[tuple[int, np.ndarray]]] = [[] for _ in range(4 if parity else 2)]
    for turn in sorted(set(turns)):
        first = turns.index(turn)
        for offset, (odd, mode) in enumerate(_modes(boundary, samples, length, turn, middle)):
            found[2 * (parity and turn % 2) + odd].append((_place(turns, first, turn, offset), mode[:kept]))
    forward, back = list[np.ndarray](), list[np.ndarray]()
    for number, members in enumerate(found):
        table = np.array([mode for _, mode in members]).reshape(len(members), kept)
        back.append(_flat(table, not outer))
        if folded % 2 and number % 2 == 0:  # the fold counts the middle twice
            table = table.copy()
            table[:, -1] /= 2
        forward.append(_flat(table.T, not outer))
    return AxisTables(
        np.concatenate(forward),
        np.concatenate(back),
        np.array([len(members) for members in found], np.int64),
        np.array([place for members in found for place, _ in members], np.int32),
        len(turns),
    )


def _modes(
    boundary: str, samples: int, length: int, turn: int, middle: float
) -> list[tuple[bool, np.ndarray]]:
    """Return the modes of a frequency, each with whether it is antisymmetric, of norm 1 over the length."""
    n = np.arange(samples)
    if boundary == "reflect":
        norm = np.sqrt((1 if turn == 0 else 2) / samples)
        return [(turn % 2 == 1, norm * np.cos(np.pi * turn * (n + 0.5) / samples))]
    angle = 2 * np.pi * turn * (n - middle) / length
    alone = turn == 0 or 2 * turn == length
    norm = np.sqrt((1 if alone else 2) / length)
    pair = [(False, norm * np.cos(angle)), (True, norm * np.sin(angle))]
    if turn == 0:
        return pair[:1]
    if alone:  # at the samples, its cosine or its sine is 0
        return pair[1:] if middle % 1 else pair[:1]
    return pair


def _place(turns: Sequence[int], first: int, turn: int, offset: int) -> int:
    return first if offset == 0 else turns.index(turn, first + 1)


def _flat(table: np.ndarray, pad: bool) -> np.ndarray:
    if pad:
        table = np.pad(table, ((0, 0), (0, -table.shape[1] % VECTOR)))
    return np.ascontiguousarray(table, np.float32).ravel()
