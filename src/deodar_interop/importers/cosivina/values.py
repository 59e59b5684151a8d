"""The parameters of one element, read with their defaults, each with a line of the report; and the sizes of
its output, with the corresponding axes.

Dimension 1 is called y, dimension 2 x, as in cosivina's own parameters (`sigmaY`, `positionX`), further ones
z and w. A dimension of one sample has no axis: a row has one axis, a single number none. Samples are at 1, 2,
..., the positions of cosivina, so that the step is 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.numerics.kernels.separable import NARROWEST
from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._values import LARGEST, ForeignValues
from deodar_interop.importers.cosivina.constructors import SIZES
from deodar_interop.importers.cosivina.file import Simulator, array


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


NAMES = ("y", "x", "z", "w")


def output_size(e: Foreign, component: str = "") -> tuple[int, ...]:
    """Return the size of an output, from the parameters."""
    declared = size(e.values.get("size"))
    rows, columns = declared[0], declared[1]
    match e.kind, component:
        case _, "horizontalSum":
            return (1, rows)
        case _, "verticalSum":
            return (1, columns)
        case _, "fullSum":
            return (1, 1)
        case "SumAllDimensions" | "BoostStimulus" | "TimedBoost" | "SingleNodeDynamics", _:
            return (1, 1)
        case kind, _ if kind in ("WeightMatrix", "AdaptiveWeightMatrix") or "1D" in kind:
            return (1, columns)
        case "DiagonalSum", _:
            return (1, 2 * size(e.values.get("inputSize"))[-1] - 1)
        case "DiagonalExpansion", _:
            side = (size(e.values.get("inputSize"))[-1] + 1) // 2
            return (side, side)
        case "RunningHistory" | "History", _:
            times = array(e.values.get("storingTimes"))
            slots = (
                size(e.values.get("timeSlots"))[-1]
                if e.kind == "RunningHistory"
                else times.size
                if times is not None
                else 1
            )
            return (slots, columns) if rows == 1 else (*declared, slots)
        case _:
            input_size = next((e.values[key] for key in (*SIZES[:1], *SIZES[2:]) if key in e.values), None)
            return size(input_size)


class Dimensions(LengthAxes):
    """The axes of a file of cosivina."""

    def __init__(self, simulator: Simulator) -> None:
        declared = [
            size(next((e.values[key] for key in SIZES if key in e.values), None)) for e in simulator.elements
        ]
        super().__init__(
            NAMES, ((n, _circular(e, n)) for e, n in zip(simulator.elements, declared, strict=True))
        )


def _circular(e: Foreign, counts: tuple[int, ...]) -> dict[int, bool]:
    """Return for the dimensions of an element whether it declares them circular."""
    out: dict[int, bool] = {}
    for d, letter in enumerate("YXZ"):
        flag_array = array(e.values.get(f"circular{letter}"))
        if flag_array is not None and flag_array.size == 1:
            out[d] = bool(flag_array.reshape(-1)[0])
    flag_array = array(e.values.get("circular"))
    if flag_array is not None and flag_array.size:
        flags = flag_array.reshape(-1)
        long = [d for d, n in enumerate(counts) if n > 1]
        for k, d in enumerate(long):
            out[d] = bool(flags[min(k, flags.size - 1)])
    return out
