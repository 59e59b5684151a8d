"""Sections of arrays: which axes a plot draws, and where the others are cut."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

import numpy as np

from deodar.numerics.axes import Axes, Axis


@dc.dataclass(frozen=True)
class Section:
    """A part of an array: all samples along the drawn axes, one number for each of the others.

    Axes of the same name have numbers (`distinct`). Names of axes that the array does not have are ignored,
    because a document can change while it is watched.

    Args:
        drawn: names of the axes that are drawn, in the order of drawing; empty: the first ones.
        at: position on axes that are not drawn, by name, in axis units. Over the other axes the maximum is
            taken.
        most: largest number of drawn axes.
    """

    drawn: tuple[str, ...] = ()
    at: tuple[tuple[str, float], ...] = ()
    most: int = 2

    def split(self, axes: Axes) -> tuple[Axes, Axes]:
        """Return the axes that are drawn, and the others."""
        axes = distinct(axes)
        chosen = self._chosen(axes)
        return tuple(axes[d] for d in chosen), tuple(a for d, a in enumerate(axes) if d not in chosen)

    def folded(self, axes: Axes) -> Axes:
        """Return the axes over which the maximum is taken."""
        cut = dict(self.at)
        return tuple(a for a in self.split(axes)[1] if a.name not in cut)

    def take(self, array: np.ndarray, axes: Axes) -> np.ndarray:
        """Return the values over the drawn axes; `array` may have others, such as time, before them."""
        axes = distinct(axes)
        chosen, cut = self._chosen(axes), dict(self.at)
        lead = array.ndim - len(axes)
        cut_away = [d for d in range(len(axes)) if d not in chosen]
        array = array.transpose(*range(lead), *(lead + d for d in (*chosen, *cut_away)))
        array = array[
            (slice(None),) * (lead + len(chosen))
            + tuple(
                nearest(axes[d], cut[axes[d].name]) if axes[d].name in cut else slice(None) for d in cut_away
            )
        ]
        over = tuple(range(lead + len(chosen), array.ndim))
        return array.max(axis=over) if over else array

    def _chosen(self, axes: Axes) -> list[int]:
        names = [a.name for a in axes]
        chosen = [names.index(name) for name in dict.fromkeys(self.drawn) if name in names][: self.most]
        return chosen or list(range(min(self.most, len(axes))))


def distinct(axes: Axes) -> Axes:
    """Return the axes with different names: a second axis "x", as of weights between two fields, is "x 2"."""
    names = [a.name for a in axes]
    if len(set(names)) == len(names):
        return axes
    counts = [names[: d + 1].count(name) for d, name in enumerate(names)]
    return tuple(
        a if k == 1 else dc.replace(a, name=f"{a.name} {k}") for a, k in zip(axes, counts, strict=True)
    )


def nearest(axis: Axis, place: float) -> int:
    """Return the index of the sample that is nearest to a position, in axis units."""
    return int(np.argmin(np.abs(axis.points - place)))


def places(axes: Sequence[Axis], at: Sequence[float]) -> tuple[int, ...]:
    """Return the index of a position; axes without a value in `at` use their middle."""
    whole = (*at, *(0.5 * (a.lower + a.upper) for a in axes[len(at) :]))
    return tuple(nearest(a, x) for a, x in zip(axes, whole, strict=False))
