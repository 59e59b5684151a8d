"""Sizes of outputs as cosivina declares them, and the corresponding axes.

Dimension 1 is called y, dimension 2 x, as in cosivina's own parameters (`sigmaY`, `positionX`), further ones
z and w. A dimension of one sample has no axis: a row has one axis, a single number none. Samples are at 1, 2,
..., the positions of cosivina, so that the step is 1.
"""

from __future__ import annotations

from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers.cosivina.file import Simulator, array
from deodar_interop.importers.cosivina.values import size

NAMES = ("y", "x", "z", "w")

SIZES = ("size", "inputSize", "outputSize", "stimulusSize")


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
