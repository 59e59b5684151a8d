"""The parameters of one element, read with their defaults; each reading adds a line to the report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.numerics.kernels.separable import NARROWEST
from deodar_interop.importers._values import LARGEST, ForeignValues
from deodar_interop.importers.cosivina.file import array


class Values(ForeignValues):
    """The parameter values of an element."""

    def single(self, name: str) -> float | None:
        numbers = array(self.body[name])
        return float(numbers.reshape(-1)[0]) if numbers is not None and numbers.size == 1 else None

    def width(self, name: str, default: float = 1.0) -> float:
        """Return the width of a Gaussian in samples.

        0 means a single sample, which a width far below the step gives.
        """
        return max(self.number(name, default, 0.0), NARROWEST)

    def flag(self, name: str, default: bool) -> bool:
        """Return a switch, written as 0 or 1."""
        return self.number(name, float(default)) != 0

    def numbers(self, name: str, default: Sequence[float], count: int) -> list[float]:
        """Return `count` numbers; a single number is repeated."""
        if name not in self.body:
            return list(default)
        numbers = array(self.body[name])
        if (
            numbers is None
            or numbers.size not in (1, count)
            or not np.isfinite(numbers).all()
            or np.abs(numbers).max() > LARGEST
        ):
            self.instead(name, list(default))
            return list(default)
        self.say(name)
        return [float(v) for v in np.broadcast_to(numbers.reshape(-1), (count,))]

    def size(self, name: str = "size", default: Sequence[int] = (1, 1)) -> tuple[int, ...]:
        """Return a size: whole numbers, at least two of them; one number is a row."""
        if name in self.body:
            self.say(name)
        return size(self.body.get(name), default)

    def matrix(self, name: str) -> np.ndarray | None:
        """Return an array of finite numbers; None without one."""
        numbers = array(self.body.get(name))
        if (
            numbers is None
            or numbers.size == 0
            or not np.isfinite(numbers).all()
            or np.abs(numbers).max() > LARGEST
        ):
            return None
        self.say(name)
        return numbers

    def periods(self, name: str = "onTimes") -> list[tuple[float, float]]:
        """Return pairs of first and last time; they may be infinite."""
        if name not in self.body:
            return []
        numbers = array(self.body[name])
        if numbers is not None and numbers.size == 0:
            self.say(name)
            return []
        if numbers is None or numbers.size % 2 or np.isnan(numbers).any():
            self.instead(name, "no moment")
            return []
        self.say(name, why="moved by one step, since cosivina counts the time before it computes")
        return [(float(a), float(b)) for a, b in numbers.reshape(-1, 2)]


def size(value: Any, default: Sequence[int] = (1, 1)) -> tuple[int, ...]:
    """Return a size by cosivina's rules: at least two whole numbers, one number is a row, trailing ones are
    dropped.
    """
    stated = array(value)
    if stated is None or stated.size == 0 or stated.size > 4 or not np.isfinite(stated).all():
        return tuple(default)
    numbers = [max(1, min(int(n), 10**9)) for n in stated.reshape(-1)]
    numbers = [1, *numbers] if len(numbers) == 1 else numbers
    while len(numbers) > 2 and numbers[-1] == 1:
        numbers.pop()
    return tuple(numbers)


def ticks(periods: Sequence[tuple[float, float]], start: float, step: float) -> list[tuple[int, int]]:
    """Return the steps of closed periods, first and last, counted from 1; periods without a step are left
    out.

    A step belongs to a period if its time does, to a millionth of a step.
    """
    out: list[tuple[int, int]] = []
    for first, last in periods:
        a, b = (max(min((t - start) / step, 1e15), -1e15) for t in (first, last))
        low, high = max(math.ceil(a - 1e-6), 0), math.floor(b + 1e-6)
        if low <= high and high >= 1:
            out.append((low, high))
    return out
