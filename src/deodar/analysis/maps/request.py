"""What a map of regimes measures: one field alone, two of its parameters, and the inputs of the protocol."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np

from deodar.analysis.isolated import Isolation, isolate
from deodar.analysis.settling_copies import (
    STRONG,
    SettlingRequest,
    driven_alone,
    only_field,
    positive,
    require_one_axis,
    with_inputs,
)
from deodar.compiler.driven import driven
from deodar.errors import ParameterError
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.parameters import show

LIMIT = 500.0
"""Longest stage, in time constants. Beside a fold the passage takes at most about 100, as slower changes
count as settled; an edge of a peak that hardly moves takes longer.
"""


class MapOptions(Isolation, total=False):
    """Keyword arguments of `regime_map`: those of `isolate`, and the longest stage in time constants."""

    limit: float


@dataclass(frozen=True, kw_only=True)
class MapRequest(SettlingRequest):
    """One field alone, and the parameters over which it is mapped.

    Attributes:
        paths: paths of both parameters in the original model.
        values: values of each.
    """

    paths: tuple[str, str]
    values: tuple[np.ndarray, np.ndarray]


def requested(
    model: Model,
    over: Mapping[str, Any],
    field: str,
    strength: float | None,
    options: MapOptions,
) -> MapRequest:
    """Return what a map measures.

    Raises:
        AnalysisError: the element is not a field with one axis or none, or a parameter changes no label.
        ParameterError: a path is unknown, changing the parameter needs another program, or its values are
            not those of an axis of a map.
    """
    limit, isolation = _divided(**options)
    longest = positive("limit", limit)
    doc = model.document
    path = field or only_field(doc)
    if len(over) != 2:
        raise ParameterError(
            f"a map has two parameters, not {len(over)}",
            fix="Name both: {'u.resting_level': (-8, -2, 50), 'u.global_inhibition': (0, 1, 50)}",
        )
    values = {name: _values(doc, name, points) for name, points in over.items()}
    isolated = isolate(model, path, **isolation)
    fix = "Measure one cell with dd.regimes, or map the same field over one axis"
    require_one_axis(isolated, "a map", fix)
    amplitude = STRONG * isolated.scale if strength is None else positive("strength", strength)
    small = with_inputs(isolated, model.trusted)
    first, second = values
    return MapRequest(
        isolated=isolated,
        model=small,
        paths=(first, second),
        values=(values[first], values[second]),
        leaves=tuple(driven_alone(doc, small.document, isolated, name) for name in values),
        strength=amplitude,
        limit=longest,
    )


def _divided(*, limit: float = LIMIT, **isolation: Unpack[Isolation]) -> tuple[float, Isolation]:
    """Return the longest stage, and the arguments of `isolate`."""
    return limit, isolation


def _values(doc: Document, path: str, points: Any) -> np.ndarray:
    """Return the values of one parameter, in growing order: given as such, or as (low, high, n)."""
    driven(doc, path)
    try:
        numbers = np.asarray(points, float)
    except (TypeError, ValueError):
        numbers = np.zeros((0, 0))
    if numbers.ndim != 1:
        raise ParameterError(
            f"the values are {show(points)}; expected numbers, or (low, high, n)", where=path
        )
    if isinstance(points, tuple) and len(numbers) == 3:
        low, high, n = (float(number) for number in numbers)
        if not float(n).is_integer() or n < 2:
            raise ParameterError(f"n is {n:g}; a map needs 2 or more values of each parameter", where=path)
        numbers = np.linspace(low, high, int(n))
    if not np.isfinite(numbers).all():
        raise ParameterError(f"the values {show(points)} are not all finite numbers", where=path)
    if len(numbers) < 2:
        raise ParameterError(
            f"has {len(numbers)} values; a map needs 2 or more of each parameter", where=path
        )
    if not (np.diff(numbers) > 0).all():
        raise ParameterError(f"the values {show(points)} do not grow from each to the next", where=path)
    for number in (numbers[0], numbers[-1]):
        edit.change(doc, path, float(number))
    return numbers
