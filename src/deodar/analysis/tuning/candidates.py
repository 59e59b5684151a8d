"""The parameters that are searched: their bounds, and the coordinates in which candidates are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from deodar.errors import ParameterError, did_you_mean
from deodar.leaves import leaves
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.parameters import real, show

FACTOR = 10.0
"""Bounds without an argument: the present value divided by this and multiplied with it (a guess)."""

LEAST = 0.5
"""Smallest unit of relative moves where bounds lie on both sides of 0, as a share of half their distance."""


@dataclass(frozen=True)
class CandidateSpace:
    """Parameters and their bounds; a candidate is a point of the unit cube.

    Bounds of one sign are searched in the logarithm of the magnitude, others evenly.

    Attributes:
        paths: paths of the parameters.
        present: their values in the model.
        low: lowest value of each.
        high: highest value of each.
    """

    paths: tuple[str, ...]
    present: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @cached_property
    def logarithmic(self) -> np.ndarray:
        """Whether each parameter is searched in the logarithm."""
        return self.low * self.high > 0

    def values(self, cube: np.ndarray) -> np.ndarray:
        """Return the values of points of the unit cube, (..., parameters)."""
        a, b = self._ends
        raw = a + (b - a) * cube
        sign = np.where(self.low < 0, -1.0, 1.0)
        return np.where(self.logarithmic, sign * np.exp(np.where(self.logarithmic, raw, 0.0)), raw)

    def cube(self, values: np.ndarray) -> np.ndarray:
        """Return points of the unit cube for values; beyond it for those beyond the bounds."""
        a, b = self._ends
        raw = np.where(self.logarithmic, np.log(np.maximum(np.abs(values), 1e-300)), values)
        return (raw - a) / (b - a)

    @cached_property
    def _ends(self) -> tuple[np.ndarray, np.ndarray]:
        def raw(values: np.ndarray) -> np.ndarray:
            return np.where(self.logarithmic, np.log(np.maximum(np.abs(values), 1e-300)), values)

        return raw(self.low), raw(self.high)

    def units(self, values: np.ndarray) -> np.ndarray:
        """Return the unit of relative moves of each parameter: its magnitude.

        Where bounds lie on both sides of 0 it is at least half the distance to the nearer bound.
        """
        least = np.where(self.logarithmic, 0.0, LEAST * np.minimum(np.abs(self.low), np.abs(self.high)))
        return np.maximum(np.abs(values), least)

    def moved(self, values: np.ndarray, relative: np.ndarray) -> np.ndarray:
        """Return values that are moved by a share of their units."""
        return values + relative * self.units(values)


def candidate_space(doc: Document, paths: Sequence[str], bounds: Mapping[str, Any] | None) -> CandidateSpace:
    """Return the space of some parameters of a document.

    Raises:
        ParameterError: a parameter is no single number, is named twice, or its bounds are not two numbers of
            its range.
    """
    if isinstance(paths, str) or not paths:
        raise ParameterError(f"the parameters are {show(paths)}; expected one path or more, in a list")
    bounds_of = dict(bounds or {})
    for path in bounds_of:
        if path not in paths:
            fix = did_you_mean(path, paths)
            raise ParameterError("has bounds and is not among the parameters", where=str(path), fix=fix)
    present: list[float] = []
    ends: list[tuple[float, float]] = []
    for k, path in enumerate(paths):
        if path in paths[:k]:
            raise ParameterError("is named twice", where=path, fix="Name it once")
        number = _single(doc, path)
        present.append(number)
        ends.append(_bounds(doc, path, bounds_of[path]) if path in bounds_of else _guessed(doc, path, number))
    low, high = np.array(ends).T
    return CandidateSpace(tuple(paths), np.array(present), low, high)


def _single(doc: Document, path: str) -> float:
    """Return the present value of a parameter that is one number."""
    number = find.value(doc, path)
    numbers = np.ravel(number) if real(number) is not None or np.ndim(number) else np.zeros(0)
    if numbers.dtype.kind not in "fiu" or numbers.size != 1:
        inside: list[str] = []
        if (target := find.target(doc, path)).entry is not None:
            inside = [n for n, _, _ in leaves(target.entry.element) if n.startswith(f"{target.parameter}.")]
        fix = f"Name one of: {', '.join(inside)}" if inside else ""
        raise ParameterError(f"is not one number, but {show(number)}", where=path, fix=fix)
    return float(numbers[0])


def _bounds(doc: Document, path: str, ends: Any) -> tuple[float, float]:
    try:
        low, high = (float(number) for number in ends)
    except (TypeError, ValueError):
        raise ParameterError(f"the bounds are {show(ends)}; expected (low, high)", where=path) from None
    if not (np.isfinite([low, high]).all() and low < high):
        raise ParameterError(
            f"the bounds are {show(ends)}; expected finite numbers, the lower one first", where=path
        )
    for number in (low, high):
        edit.change(doc, path, number)
    return low, high


def _guessed(doc: Document, path: str, value: float) -> tuple[float, float]:
    """Return bounds around the present value, inside the range of the parameter."""
    fix = f"Give bounds={{{path!r}: (low, high)}}"
    if value == 0:
        raise ParameterError("is 0, so that its bounds cannot be guessed", where=path, fix=fix)
    low, high = sorted((value / FACTOR, value * FACTOR))
    for lowest, highest in _declared(doc, path):
        low = low if lowest is None else max(low, lowest)
        high = high if highest is None else min(high, highest)
    if not low < high:
        raise ParameterError("has no other value near the present one in its range", where=path, fix=fix)
    return low, high


def _declared(doc: Document, path: str) -> list[tuple[float | None, float | None]]:
    """Return the declared ranges of the numbers that a parameter drives."""
    target = find.target(doc, path)
    if target.entry is None:
        links = next(k.links for k in doc.parameters if k.name == target.parameter)
        pairs = [(find.entry(doc, ident), leaf) for ident, leaf in links]
    else:
        pairs = [(target.entry, target.parameter)]
    out: list[tuple[float | None, float | None]] = []
    for entry, leaf in pairs:
        for name, _, parameter in leaves(entry.element):
            if name == leaf or name.startswith(f"{leaf}."):
                out.append((parameter.lower, parameter.upper))
    return out
