"""What a look sees of a port or of a sensor: its values, or one number that is made of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.errors import AxesError, UnknownName
from deodar.model import find
from deodar.model.document import Document, Entry
from deodar.numerics.axes import Axes

REDUCES: Mapping[str, Callable[..., Any]] = {"max": np.max, "min": np.min, "mean": np.mean, "sum": np.sum}
PLACE = "place"
"""Reduction to where the largest sample stands, in axis units: one number, or one for each axis."""


@dataclass(frozen=True)
class View:
    """What is looked at.

    Attributes:
        of: path of a port, or name of a sensor of the world.
        reduce: max, min, mean or sum of all samples, or `place` of the largest; empty: the values as they are.
        near: only samples around this place, in axis units, one number for each axis; empty: all.
        radius: how far around it, along every axis.
        port: which port a path without one means.
    """

    of: str
    reduce: str = ""
    near: tuple[float, ...] = ()
    radius: float = 0.0
    port: str = "output"

    def place(self, doc: Document) -> tuple[Entry, str]:
        """The element and the port that it means in a document; an unknown one is an error that suggests the nearest."""
        entry, port = find.port(doc, self.of, "")
        port = port or self.port
        if port not in find.readable(entry):
            raise UnknownName(f"{entry.path} has no port {port!r}", fix=f"Ports: {', '.join(find.readable(entry))}")
        return entry, port

    def seen(self, values: np.ndarray, axes: Axes | None, lead: int) -> np.ndarray:
        """What it makes of values, whose first `lead` axes count copies and looks and are kept."""
        if not self.reduce:
            return values
        flat = values.reshape(*values.shape[:lead], -1)
        inside = None if axes is None else mask(axes, self.near, self.radius)
        points = None if axes is None else places(axes)
        if inside is not None:
            flat, points = flat[..., inside.ravel()], points if points is None else points[inside.ravel()]
        if self.reduce == PLACE:
            assert points is not None
            found = points[flat.argmax(axis=-1)]
            return found[..., 0] if found.shape[-1] == 1 else found
        return REDUCES[self.reduce](flat, axis=-1)


def mask(axes: Axes, near: Sequence[float], radius: float) -> np.ndarray | None:
    """Which samples lie within a radius of a place along every axis, the shorter way round where it wraps; None: all do.

    Raises:
        AxesError: the place does not fit the axes, or no sample lies there.
    """
    if not near:
        return None
    if len(near) != len(axes):
        raise AxesError(f"the place {list(near)} has {len(near)} numbers, and there are {len(axes)} axes", fix="Give one for each axis")
    inside = np.ones((), bool)
    for axis, at in zip(axes, near, strict=True):
        away = axis.points - at
        if axis.periodic:
            away = away - axis.range * np.round(away / axis.range)
        inside = inside[..., None] & (np.abs(away) <= radius + 1e-9 * axis.range)
    if not inside.any():
        raise AxesError(f"no sample lies within {radius:g} of {list(near)}", fix=f"The axes are {', '.join(map(str, axes))}")
    return inside


def places(axes: Axes) -> np.ndarray | None:
    """Where each sample stands, (samples, axes); None without axes."""
    return np.stack([a.ravel() for a in np.meshgrid(*(axis.points for axis in axes), indexing="ij")], axis=-1) if axes else None
