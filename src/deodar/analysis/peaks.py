"""Peaks: connected regions of activation above a threshold, on periodic or bounded axes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from scipy import ndimage

from deodar.errors import AnalysisError
from deodar.numerics.axes import Axes, Axis, cell, describe, shape
from deodar.summary import Summarised, Summary, counted

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Peak:
    """One connected region above the threshold.

    Attributes:
        position: centroid in axis units, one number for each axis, weighted by the activation above
            threshold.
        width: extent along each axis, in axis units: the length of the section through the highest sample
            between the (interpolated) threshold crossings of the activation. On one axis this is the width of
            the region.
        amplitude: highest activation.
        size: volume in the product of the axis units (on one axis the width; 1 for a node).
        samples: number of samples above threshold.
    """

    position: tuple[float, ...]
    width: tuple[float, ...]
    amplitude: float
    size: float
    samples: int

    def __repr__(self) -> str:
        if not self.position:
            return f"Peak(amplitude={self.amplitude:.4g})"
        return (
            f"Peak(at={_tuple(self.position)}, width={_tuple(self.width)}, amplitude={self.amplitude:.4g},"
            f" size={self.size:.4g})"
        )


@dataclass(frozen=True, repr=False)
class Peaks(Summarised, Sequence[Peak]):
    """The peaks of one activation pattern, in descending order of amplitude."""

    found: tuple[Peak, ...]
    axes: Axes
    threshold: float

    def __len__(self) -> int:
        return len(self.found)

    def __iter__(self) -> Iterator[Peak]:
        return iter(self.found)

    @overload
    def __getitem__(self, index: int) -> Peak: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Peak, ...]: ...
    def __getitem__(self, index: int | slice) -> Peak | tuple[Peak, ...]:
        return self.found[index]

    def __repr__(self) -> str:
        return (
            f"<{len(self)} peak{'' if len(self) == 1 else 's'} above {self.threshold:g}"
            + "".join(f"\n  {p!r}" for p in self)
            + ">"
        )

    def _summary(self) -> Summary:
        units = [f" ({a.unit})" if a.unit else "" for a in self.axes]
        places = [f"{a.name}{unit}" for a, unit in zip(self.axes, units, strict=True)]
        heads = [*places, *(f"width of {place}" for place in places), "amplitude", "size"]
        rows = [[f"{v:.4g}" for v in (*p.position, *p.width, p.amplitude, p.size)] for p in self]
        return Summary(f"{counted(len(self), 'peak')} above {self.threshold:g}", rows, heads)


def peaks(
    activation: np.ndarray | xarray.DataArray, axes: Sequence[Axis] | None = None, threshold: float = 0.0
) -> Peaks:
    """Find the peaks of an activation pattern.

    Samples above the threshold that share a face belong to one peak, also across the border of a periodic
    axis. A node has one peak while its activation is above the threshold.

    Args:
        activation: an array over the axes; or a variable of a record, at one time
            (`data["u.activation"].isel(time=-1)`).
        axes: axes of the array, in order; none for a variable of a record, whose coordinates define them.
        threshold: threshold in units of activation; usually where the output function is 0.5.

    Raises:
        AnalysisError: if the array does not fit the axes, is not finite, or has dimensions that are not axes.

    Reference:
        Amari (1977), Biol. Cybern. 27, 77-87, section 3 (the excited region R[u], where u > 0).
    """
    if axes is None:
        u, found_axes = _variable(activation)
    else:
        u, found_axes = np.asarray(activation, np.float64), tuple(axes)
    if u.shape != shape(found_axes):
        raise AnalysisError(
            f"the activation has the shape {list(u.shape)}; the axes are {describe(found_axes)}"
        )
    if not np.isfinite(u).all():
        raise AnalysisError("the activation holds values that are not finite numbers")
    above = u - threshold
    labels = _regions(above > 0, found_axes)
    reach = [_reach(above, labels, d, a) for d, a in enumerate(found_axes)]
    regions = [_peak(above, threshold, labels, places, found_axes, reach) for places in _places(labels)]
    return Peaks(
        tuple(sorted(regions, key=lambda p: (-p.amplitude, p.position))), found_axes, float(threshold)
    )


# ---------------------------------------------------------------------------------------------------- regions


def _regions(mask: np.ndarray, axes: Axes) -> np.ndarray:
    """Return labels of the connected regions, 0 outside; equal on both sides of a periodic border."""
    if not axes:
        return mask.astype(np.int64)
    labelled: Any = ndimage.label(mask)
    labels, count = labelled
    root = np.arange(count + 1)

    def find(i: int) -> int:
        while root[i] != i:
            i = int(root[i])
        return i

    for d, axis in enumerate(axes):
        if axis.periodic:
            first, last = np.take(labels, 0, axis=d), np.take(labels, -1, axis=d)
            joined = (first > 0) & (last > 0)
            for a, b in sorted(set(zip(first[joined].tolist(), last[joined].tolist(), strict=True))):
                low, high = sorted((find(a), find(b)))
                root[high] = low
    return np.array([find(i) for i in range(count + 1)])[labels]


def _places(labels: np.ndarray) -> list[np.ndarray]:
    """Return the flat indices of the samples of each region."""
    flat = labels.ravel()
    order = np.argsort(flat, kind="stable")
    cuts = np.flatnonzero(np.diff(flat[order])) + 1
    return [part for part in np.split(order, cuts) if flat[part[0]] > 0]


def _reach(above: np.ndarray, labels: np.ndarray, d: int, axis: Axis) -> np.ndarray:
    """Return the length along axis d that each sample of a region covers, in steps.

    On each side it is half a step towards another sample of the region, else the distance to the threshold
    crossing, and 0 at a border that does not wrap.
    """
    total = np.zeros(above.shape)
    for side in (1, -1):
        neighbour = np.roll(above, -side, axis=d)
        crossing = (above > 0) & (neighbour <= 0)
        part = np.where(
            neighbour > 0, 0.5, np.where(crossing, above, 0.0) / np.where(crossing, above - neighbour, 1.0)
        )
        if not axis.periodic:
            part[(slice(None),) * d + (-1 if side == 1 else 0,)] = 0.0
        total += part
    return np.where(labels > 0, total, 0.0)


# ------------------------------------------------------------------------------------- measures of one region


def _peak(
    above: np.ndarray,
    threshold: float,
    labels: np.ndarray,
    places: np.ndarray,
    axes: Axes,
    reach: list[np.ndarray],
) -> Peak:
    weights = above.ravel()[places]
    highest = int(places[int(np.argmax(weights))])
    amplitude = float(weights.max() + threshold)
    if not axes:
        return Peak((), (), amplitude, 1.0, 1)
    index = np.unravel_index(places, above.shape)
    top = np.unravel_index(highest, above.shape)
    position = tuple(
        _centre(axis, axis.points[i], weights, axis.points[t])
        for axis, i, t in zip(axes, index, top, strict=True)
    )
    width = tuple(_cut(labels, reach[d], axis, d, top) for d, axis in enumerate(axes))
    size = float(reach[-1].ravel()[places].sum()) * cell(axes)
    return Peak(position, width, amplitude, size, len(places))


def _centre(axis: Axis, points: np.ndarray, weights: np.ndarray, top: float) -> float:
    """Return the centroid; on a periodic axis that of the distances from the circular mean, which is exact
    for regions shorter than half the period.
    """
    if not axis.periodic:
        return float(np.average(points, weights=weights))
    turn = 2 * math.pi / axis.range
    mean = np.average(np.exp(1j * turn * (points - axis.lower)), weights=weights)
    # a region over the whole period has no defined middle
    middle = axis.lower + float(np.angle(mean)) / turn if abs(mean) > 1e-9 else top
    offset = points - middle
    offset = offset - axis.range * np.round(offset / axis.range)
    centre = middle + float(np.average(offset, weights=weights)) if abs(mean) > 1e-9 else top
    wrapped = (centre - axis.lower) % axis.range
    return axis.lower + (0.0 if axis.range - wrapped < 1e-9 * axis.range else wrapped)


def _cut(labels: np.ndarray, reach: np.ndarray, axis: Axis, d: int, top: tuple[Any, ...]) -> float:
    """Return the length of the region's section along axis d through its highest sample."""
    line = tuple(slice(None) if k == d else int(i) for k, i in enumerate(top))
    inside = labels[line] == labels[top]
    start, n = int(top[d]), axis.samples
    run = [start]
    for side in (1, -1):
        i = start + side
        while len(run) < n and (axis.periodic or 0 <= i < n) and inside[i % n]:
            run.append(i % n)
            i += side
    return float(reach[line][run].sum()) * axis.step


# -------------------------------------------------------------------------------------- variables of a record


def _variable(variable: Any) -> tuple[np.ndarray, Axes]:
    """Return the array and the axes of a variable of a record; other dimensions must have one entry."""
    if not hasattr(variable, "coords") or not hasattr(variable, "dims"):
        raise AnalysisError(
            "an array alone does not say what its axes are", fix="Give them: peaks(activation, [x])"
        )
    singles = [str(d) for d in variable.dims if not _is_axis(variable, d)]
    many = [d for d in singles if variable.sizes[d] != 1]
    if many:
        fix = ", ".join(f"{d}=-1" for d in many)
        raise AnalysisError(
            f"{variable.name} still has the dimension{'s' if len(many) > 1 else ''} {', '.join(many)}",
            fix=f"Choose one: .isel({fix})",
        )
    variable = variable.isel(dict.fromkeys(singles, 0))
    return np.asarray(variable.values, np.float64), tuple(_axis(variable, d) for d in variable.dims)


def _is_axis(variable: Any, dim: Any) -> bool:
    return dim in variable.coords and "periodic" in variable.coords[dim].attrs


def _axis(variable: Any, dim: Any) -> Axis:
    coordinate = variable.coords[dim]
    attributes, points = coordinate.attrs, np.asarray(coordinate.values, float)
    unit = str(attributes.get("units", ""))
    axis = Axis(
        str(dim),
        float(attributes["lower"]),
        float(attributes["upper"]),
        len(points),
        bool(attributes["periodic"]),
        unit,
    )
    if np.allclose(axis.points, points, rtol=0, atol=1e-6 * axis.range):
        return axis
    # a part of the axis: bounded by its samples, and not periodic
    if (
        len(points) < 2
        or not np.allclose(np.diff(points), points[1] - points[0], rtol=1e-6, atol=0)
        or points[1] <= points[0]
    ):
        raise AnalysisError(f"the values of {dim} are not evenly spaced and growing")
    return Axis(str(dim), float(points[0]), float(points[-1]), len(points), False, unit)


def _tuple(values: tuple[float, ...]) -> str:
    return f"{values[0]:.4g}" if len(values) == 1 else "(" + ", ".join(f"{v:.4g}" for v in values) + ")"
