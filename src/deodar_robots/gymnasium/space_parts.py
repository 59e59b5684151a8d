"""Spaces of Gymnasium as signals: readings from observations, and actions from values of motors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.worlds._base import Signal
from deodar_robots.gymnasium.package import package

NUMBERS = ("Box", "Discrete", "MultiDiscrete", "MultiBinary")
"""Spaces whose elements are arrays of numbers."""


@dataclass(frozen=True)
class SpacePart:
    """A part of a space that is one signal.

    Attributes:
        keys: the keys of the dictionaries that lead to the part; empty: the space itself.
        space: its space, one of `NUMBERS`.
        name: name of the environment, for messages.
    """

    keys: tuple[str, ...]
    space: Any
    name: str

    @property
    def shape(self) -> tuple[int, ...]:
        """Samples along each axis; an array of shape (1,) is one number."""
        shape = tuple(int(n) for n in self.space.shape or ())
        return () if shape == (1,) else shape

    def signal(self, meaning: str) -> Signal:
        """Return the description of the part; it states bounds that are finite."""
        low, high = limits(self.space)
        known = len(self.shape) <= 1 and bool(np.isfinite(low).all() and np.isfinite(high).all())
        pairs = tuple(zip(low.ravel().tolist(), high.ravel().tolist(), strict=True))
        return Signal(
            f"{meaning}, {text(self.space)}", self.shape, each=True, bounds=pairs if known else None
        )

    def reading(self, element: Any) -> np.ndarray:
        """Return the numbers of this part in an element of the whole space.

        Raises:
            WorldError: the part is missing, or has another shape than its space.
        """
        for key in self.keys:
            if not isinstance(element, Mapping) or key not in element:
                raise WorldError(f"the observation has no key {key!r}, which its space has", where=self.name)
            element = element[key]
        try:
            found = np.asarray(element, float)
        except (TypeError, ValueError):
            raise WorldError(
                f"{self._label()} is a {type(element).__name__}; its space has numbers", where=self.name
            ) from None
        if found.shape != tuple(self.space.shape or ()):
            raise WorldError(
                f"{self._label()} has the shape {list(found.shape)}; its space has"
                f" {list(self.space.shape or ())}",
                where=self.name,
            )
        return found.reshape(self.shape)

    def action(self, values: np.ndarray) -> Any:
        """Return the action for values of a motor, inside the space: numbers are limited to its bounds, and
        rounded where it has whole numbers.
        """
        low, high = limits(self.space)
        given = np.reshape(np.asarray(values, float), low.shape)
        kind = type(self.space).__name__
        if kind == "MultiBinary":
            return (given > 0.5).astype(self.space.dtype)
        whole = np.dtype(self.space.dtype).kind in "iu"
        inside = np.clip(np.rint(given) if whole else given, low, high)
        return np.int64(inside) if kind == "Discrete" else inside.astype(self.space.dtype)

    def _label(self) -> str:
        return ".".join(self.keys) or "the observation"


def parts(space: Any, alone: str, name: str) -> dict[str, SpacePart]:
    """Return the parts of a space by the names of their signals.

    A dictionary has a signal for each key; keys of dictionaries inside it follow after a dot. Any other space
    is one signal.

    Args:
        space: the space.
        alone: name of the signal of a space that is no dictionary.
        name: name of the environment, for messages.

    Raises:
        WorldError: a part has no numbers, such as text.
    """
    found: dict[str, SpacePart] = {}

    def add(inner: Any, keys: tuple[str, ...]) -> None:
        if isinstance(inner, package().spaces.Dict):
            for key, part in inner.spaces.items():
                add(part, (*keys, str(key)))
            return
        label = ".".join(keys) or alone
        if type(inner).__name__ not in NUMBERS or not isinstance(inner, package().Space):
            raise WorldError(
                f"the space of {label!r} is {type(inner).__name__}, which cannot be a signal",
                where=name,
                fix=f"Wrap the environment: {', '.join(NUMBERS)} and Dict of these can be signals",
            )
        if 0 in (inner.shape or ()):
            raise WorldError(f"the space of {label!r} has no numbers: {inner}", where=name)
        if label in found:
            raise WorldError(f"has two parts called {label!r}", where=name, fix="Wrap the environment")
        found[label] = SpacePart(keys, inner, name)

    add(space, ())
    return found


def joined(parts: Mapping[str, SpacePart], values: Mapping[str, np.ndarray]) -> Any:
    """Return an element of the whole space from the values of its motors; those not given are 0."""
    out: dict[str, Any] = {}
    for name, part in parts.items():
        action = part.action(values.get(name, np.zeros(part.shape)))
        if not part.keys:
            return action
        at = out
        for key in part.keys[:-1]:
            at = at.setdefault(key, {})
        at[part.keys[-1]] = action
    return out


def limits(space: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the smallest and largest value of each number of a space, in the shape of its elements."""
    kind, shape = type(space).__name__, tuple(space.shape or ())
    if kind == "Box":
        return np.asarray(space.low, float), np.asarray(space.high, float)
    if kind == "MultiBinary":
        return np.zeros(shape), np.ones(shape)
    start = np.broadcast_to(np.asarray(space.start, float), shape)
    count = space.n if kind == "Discrete" else space.nvec
    return start, start + np.asarray(count, float) - 1


def text(space: Any) -> str:
    """Return the bounds of a space in words."""
    low, high = limits(space)
    if type(space).__name__ == "MultiBinary":
        return "each 0 or 1"
    whole = "whole numbers " if np.dtype(space.dtype).kind in "iu" else ""
    if (low == low.flat[0]).all() and (high == high.flat[0]).all():
        return f"{whole}from {low.flat[0]:g} to {high.flat[0]:g}"
    if low.size > 8:
        return f"{whole}from {low.min():g} to {high.max():g}"
    return whole + ", ".join(f"{a:g} to {b:g}" for a, b in zip(low.flat, high.flat, strict=True))
