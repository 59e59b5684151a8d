"""Sizes of outputs as cosivina declares them, and the corresponding axes.

Dimension 1 is called y, dimension 2 x, as in cosivina's own parameters (`sigmaY`, `positionX`), further ones
z and w. A dimension of one sample has no axis: a row has one axis, a single number none. Samples are at 1, 2,
..., the positions of cosivina, so that the step is 1.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from deodar.importers._foreign import Foreign
from deodar.importers._piece import Dims
from deodar.importers.cosivina.file import Simulator, array
from deodar.importers.cosivina.values import size
from deodar.numerics.axes import MOST_SAMPLES, Axis

NAMES = ("y", "x", "z", "w")

MOST_CELLS = 10_000_000
"""Largest number of samples; a larger array is probably an error (a guess; it would take 80 MB)."""


class SizeLimit(ValueError):
    """Raised if a size is implausibly large."""


SIZES = ("size", "inputSize", "outputSize", "stimulusSize")


def output_size(e: Foreign, component: str = "") -> tuple[int, ...]:
    """Return the size of an output, from the parameters."""
    own = size(e.values.get("size"))
    rows, columns = own[0], own[1]
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
            return (slots, columns) if rows == 1 else (*own, slots)
        case _:
            given = next((e.values[key] for key in (*SIZES[:1], *SIZES[2:]) if key in e.values), None)
            return size(given)


class Dimensions:
    """The axes of a file: one for each dimension and length, and whether the lengths wrap."""

    def __init__(self, simulator: Simulator) -> None:
        self.used: list[Counter[int]] = [Counter() for _ in NAMES]
        self.wraps: Counter[int] = Counter()
        for e in simulator.elements:
            own = size(next((e.values[key] for key in SIZES if key in e.values), None))
            for d, count in enumerate(own):
                self.used[d][count] += count > 1
            for d, circular in _circular(e, own).items():
                if d < len(own):
                    self.wraps[own[d]] += 1 if circular else -1
        self.common = [max(used, key=lambda n: (used[n], n), default=0) for used in self.used]

    def of(self, counts: Sequence[int]) -> Dims:
        """Return the axes of a size.

        All dimensions of one length wrap, or none: as most kernels and stimuli of this length do.

        Raises:
            TooLarge: a size is implausibly large.
        """
        total = 1
        for count in counts:
            total *= count
        if max(counts) > MOST_SAMPLES or total > MOST_CELLS:
            raise SizeLimit(f"its size {list(counts)} is more than {MOST_CELLS} samples")
        return tuple(self.axis(d, n) if n > 1 else None for d, n in enumerate(counts))

    def axis(self, d: int, count: int) -> Axis:
        """Return the axis of one dimension."""
        common = self.common[d]
        name = NAMES[d] if count == common or not self.used[d][common] else f"{NAMES[d]}{count}"
        periodic = self.wraps[count] > 0
        return Axis(name, 1, count + 1 if periodic else count, count, periodic)


def _circular(e: Foreign, own: tuple[int, ...]) -> dict[int, bool]:
    """Return for the dimensions of an element whether it declares them circular."""
    out: dict[int, bool] = {}
    for d, letter in enumerate("YXZ"):
        found = array(e.values.get(f"circular{letter}"))
        if found is not None and found.size == 1:
            out[d] = bool(found.reshape(-1)[0])
    found = array(e.values.get("circular"))
    if found is not None and found.size:
        flags = found.reshape(-1)
        long = [d for d, n in enumerate(own) if n > 1]
        for k, d in enumerate(long):
            out[d] = bool(flags[min(k, flags.size - 1)])
    return out
