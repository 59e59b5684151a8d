"""What events and measures observe of a port or a sensor: its values, or one number computed from them."""

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

REDUCES: Mapping[str, Callable[..., Any]] = {"max": np.max, "min": np.min, "mean": np.mean, "sum": np.sum}
PLACE = "place"
"""Reduction to the position of the highest peak, in axis units: one number, or one for each axis."""


@dataclass(frozen=True)
class Observable:
    """What is looked at.

    Attributes:
        of: path of a port, or name of a sensor of the world.
        reduce: max, min, mean or sum of all samples, or `place` of the highest peak; empty: the values as
            they are.
        near: only samples around this place, in axis units, one number for each axis; empty: all.
        radius: how far around it, along every axis.
        port: which port a path without one means; empty: of a field its activation, else the default output.
        threshold: samples above it belong to a peak, for `place`.
    """

    of: str
    reduce: str = ""
    near: tuple[float, ...] = ()
    radius: float = 0.0
    port: str = ""
    threshold: float = 0.0

    def place(self, doc: Document) -> tuple[Entry, str]:
        """The element and the port that it means in a document; an unknown one is an error that suggests the
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
        """What it makes of values, whose first `lead` axes count copies and looks and are kept."""
        if not self.reduce:
            return values
        inside = None if axes is None else mask(axes, self.near, self.radius)
        if self.reduce == PLACE:
            assert axes is not None
            found = np.array(
                [self._position(u, axes, inside) for u in values.reshape(-1, *values.shape[lead:])]
            )
            return found.reshape(values.shape[:lead] if len(axes) == 1 else (*values.shape[:lead], len(axes)))
        flat = values.reshape(*values.shape[:lead], -1)
        if inside is not None:
            flat = flat[..., inside.ravel()]
        return REDUCES[self.reduce](flat, axis=-1)

    def given(self, values: np.ndarray) -> np.ndarray:
        """What it makes of the output of its reader (`reader.py`): a position is NaN where there is no
        peak.
        """
        if self.reduce != PLACE:
            return values
        found = np.where(values[..., -1:] > 0.5, values[..., :-1], np.nan)
        return found[..., 0] if found.shape[-1] == 1 else found

    def _position(self, values: np.ndarray, axes: Axes, inside: np.ndarray | None) -> Sequence[float]:
        u = values if inside is None else np.where(inside, values, np.minimum(values, self.threshold))
        found = peaks(u, axes, self.threshold)
        return found[0].position if found else (np.nan,) * len(axes)


def mask(axes: Axes, near: Sequence[float], radius: float) -> np.ndarray | None:
    """Which samples lie within a radius of a place along every axis, the shorter way round where it wraps;
    None: all do.

    Raises:
        AxesError: the place does not fit the axes, or no sample lies there.
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
        away = axis.points - at
        if axis.periodic:
            away = away - axis.range * np.round(away / axis.range)
        inside = inside[..., None] & (np.abs(away) <= radius + 1e-9 * axis.range)
    if not inside.any():
        raise AxesError(
            f"no sample lies within {radius:g} of {list(near)}",
            fix=f"The axes are {', '.join(map(str, axes))}",
        )
    return inside
