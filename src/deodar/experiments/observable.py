"""Observables of events and measures: the values of a port or sensor, or one number computed from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.analysis.peaks import peaks
from deodar.errors import AxesError, UnknownName
from deodar.model import find
from deodar.model.document import Document, Entry
from deodar.numerics.axes import Axes
from deodar.parameters import PerAxis

REDUCES: Mapping[str, Callable[..., Any]] = {"max": np.max, "min": np.min, "mean": np.mean, "sum": np.sum}
PLACE = "place"
"""Reduction to the position of the highest peak, in axis units: one number, or one per axis."""


@dataclass(frozen=True)
class Observable:
    """An observed port or sensor, and its reduction.

    Attributes:
        of: path of a port, or name of a sensor of the world.
        reduce: max, min, mean or sum of all samples, or `place` of the highest peak; empty: all values.
        near: only samples around this position, in axis units, one number per axis; empty: all.
        radius: distance from that position, along every axis.
        port: the port that a path without a port means; empty: of a field its activation, else the default
            output.
        threshold: samples above it belong to a peak, for `place`.
    """

    of: str
    reduce: str = ""
    near: tuple[float, ...] = ()
    radius: float = 0.0
    port: str = ""
    threshold: float = 0.0

    def place(self, doc: Document) -> tuple[Entry, str]:
        """Return the element and the port in a document; the error of an unknown path suggests the
        nearest.
        """
        if not self.port:
            return find.shown(doc, self.of)
        entry, port = find.port(doc, self.of, "")
        port = port or self.port
        if port not in find.readable(entry):
            raise UnknownName(
                f"{entry.path} has no port {port!r}", fix=f"Ports: {', '.join(find.readable(entry))}"
            )
        return entry, port

    def seen(self, values: np.ndarray, axes: Axes | None, lead: int) -> np.ndarray:
        """Return the reduction of values, whose first `lead` axes (copies and sampling times) are kept."""
        if not self.reduce:
            return values
        inside = None if axes is None else mask(axes, self.near, self.radius)
        if self.reduce == PLACE:
            assert axes is not None
            positions = np.array(
                [self._position(u, axes, inside) for u in values.reshape(-1, *values.shape[lead:])]
            )
            return positions.reshape(
                values.shape[:lead] if len(axes) == 1 else (*values.shape[:lead], len(axes))
            )
        flat = values.reshape(*values.shape[:lead], -1)
        if inside is not None:
            flat = flat[..., inside.ravel()]
        return REDUCES[self.reduce](flat, axis=-1)

    def from_reader(self, values: np.ndarray) -> np.ndarray:
        """Return the reduction from the output of its reader (`field_reader.py`): a position without a peak
        is NaN.
        """
        if self.reduce != PLACE:
            return values
        coordinates = np.where(values[..., -1:] > 0.5, values[..., :-1], np.nan)
        return coordinates[..., 0] if coordinates.shape[-1] == 1 else coordinates

    def _position(self, values: np.ndarray, axes: Axes, inside: np.ndarray | None) -> Sequence[float]:
        u = values if inside is None else np.where(inside, values, np.minimum(values, self.threshold))
        peaks_inside = peaks(u, axes, self.threshold)
        return peaks_inside[0].position if peaks_inside else (np.nan,) * len(axes)


def position(near: PerAxis | None) -> tuple[float, ...]:
    """Return a position as `Observable` has it."""
    if near is None:
        return ()
    return tuple(map(float, near)) if isinstance(near, Sequence) else (float(near),)


def mask(axes: Axes, near: Sequence[float], radius: float) -> np.ndarray | None:
    """Return which samples are within a radius of a position along every axis, with wrapping; None: all are.

    Raises:
        AxesError: the position does not fit the axes, or no sample is within the radius.
    """
    if not near:
        return None
    if len(near) != len(axes):
        raise AxesError(
            f"the place {list(near)} has {len(near)} numbers, and there are {len(axes)} axes",
            fix="Give one for each axis",
        )
    inside = np.ones((), bool)
    for axis, at in zip(axes, near, strict=True):
        distance = axis.points - at
        if axis.periodic:
            distance = distance - axis.range * np.round(distance / axis.range)
        inside = inside[..., None] & (np.abs(distance) <= radius + 1e-9 * axis.range)
    if not inside.any():
        raise AxesError(
            f"no sample lies within {radius:g} of {list(near)}",
            fix=f"The axes are {', '.join(map(str, axes))}",
        )
    return inside
