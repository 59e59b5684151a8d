"""The dimensions of an array of cosivina for the axes of the document, and positions in samples.

Axes of an imported file keep their dimension: `y` is the first, `x` the second, `z` and `w` follow. Other
axes are taken in their order: one axis is a row, two are the rows and columns of a plane.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

from deodar.leaves import per_axis
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.convolution import boundaries
from deodar.numerics.kernels.separable import NARROWEST
from deodar.parameters import PerAxis
from deodar_interop.importers._piece import Dims
from deodar_interop.importers.cosivina.values import NAMES


def layout(axes: Axes) -> Dims:
    """Return the axis of each dimension, at least two; None for a dimension of one sample."""
    places = [p for a in axes if (p := _imported(a)) is not None]
    if axes and len(places) == len(axes) and all(p < q for p, q in itertools.pairwise(places)):
        found: list[Axis | None] = [None] * max(2, places[-1] + 1)
        for p, a in zip(places, axes, strict=True):
            found[p] = a
        return tuple(found)
    return tuple(axes) if len(axes) > 1 else (None, axes[0] if axes else None)


def size(dims: Dims) -> list[int]:
    """Return a size as cosivina writes it."""
    return [1 if a is None else a.samples for a in dims]


def is_row(dims: Dims) -> bool:
    """Return whether an array is a row, the form that the one-dimensional classes take."""
    return len(dims) == 2 and dims[0] is None


def position(axis: Axis, value: float) -> float:
    """Return a position on an axis in samples, counted from 1."""
    return value if axis.lower == 1 and axis.step == 1 else (value - axis.lower) / axis.step + 1


def width(axis: Axis, value: float) -> float:
    """Return a width in samples; a width far below the step is 0, a single sample."""
    return 0.0 if value <= NARROWEST else value / axis.step


def positions(axes: Axes, values: PerAxis) -> list[float]:
    """Return the positions on each axis in samples."""
    return [position(a, v) for a, v in zip(axes, per_axis(values, axes), strict=True)]


def widths(axes: Axes, values: PerAxis) -> list[float]:
    """Return the widths along each axis in samples."""
    return [width(a, v) for a, v in zip(axes, per_axis(values, axes), strict=True)]


def circular(axes: Axes, given: Sequence[str] | None) -> list[bool]:
    """Return for each axis whether the space wraps."""
    return [end == "periodic" for end in boundaries(given, axes)]


def _imported(axis: Axis) -> int | None:
    """Return the dimension that an importer gave to an axis; None for an axis of another origin."""
    found = re.fullmatch(r"([yxzw])(\d*)", axis.name)
    plain = Axis(axis.name, 1, axis.samples + axis.periodic, axis.samples, axis.periodic)
    if found is None or axis != plain or found[2] not in ("", str(axis.samples)):
        return None
    return NAMES.index(found[1])
