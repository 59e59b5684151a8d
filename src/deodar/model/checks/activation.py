"""States that cannot occur, because the strengths of a model do not allow them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from deodar.couplings.hebbian import Hebbian
from deodar.couplings.peak_position import PeakPosition
from deodar.couplings.rate_code import RateCode
from deodar.couplings.threshold import Threshold
from deodar.elements.field import Field
from deodar.elements.memory_trace import MemoryTrace
from deodar.elements.rate_node import RateNode
from deodar.errors import Problem
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import cell
from deodar.numerics.sigmoids.linear import Linear
from deodar.numerics.sigmoids.logistic import Logistic

SILENT = 0.25
"""Output below which a field counts as silent (a guess: half of the output at its threshold)."""

CLEAR = 0.15
"""Share of the distance from the resting level to the threshold that is missing; a field that comes nearer
may reach it with a small input (a guess).
"""

AT_REST = 0.2
"""Output at the resting level from which a sigmoid counts as too flat (a guess)."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Report fields that are never or always on, and thresholds that no signal reaches."""
    for n in wiring.declared:
        if isinstance(n.element, (Field, RateNode)) and not isinstance(n.element.sigmoid, Linear):
            yield from _field(wiring, n, n.element)
        else:
            yield from _waiting(wiring, n)


def _field(wiring: Wiring, n: Node, e: Field | RateNode) -> Iterator[Problem]:
    threshold: float = getattr(e.sigmoid, "threshold", 0.0)
    h, (low, high) = e.resting_level, wiring.arriving(n)
    rest, (_, most) = (
        e.sigmoid.bounds((h, h))[1],
        wiring.bounds[n.id].get("activation", (-math.inf, math.inf)),
    )
    silent = most < threshold - CLEAR * (threshold - h) and e.sigmoid.bounds((most, most))[1] < SILENT
    if silent and not n.reads["input"] and wiring.driven:
        what = (
            f"nothing is connected to it, and its resting level {h:g} lies below its threshold {threshold:g}:"
            " it is never active"
        )
        yield warning(n, what, f"Connect an input: model.connect(..., {n.path!r}); or remove it")
    elif silent and n.id in wiring.driven and high <= 0 and low < 0:
        what = (
            f"gets only inhibition (at most {high:g}), and its resting level {h:g} lies below its threshold"
            f" {threshold:g}: it is never on"
        )
        yield warning(n, what, "Change the sign of what should excite it, or connect what does")
    elif silent and n.id in wiring.driven:
        what = (
            f"never reaches its threshold {threshold:g}: its resting level is {h:g}, its inputs add at most"
            f" {high:.3g}, and its own excitation does not help below the threshold; activation stays below"
            f" {most:.3g}"
        )
        yield warning(
            n,
            what,
            f"Make its inputs stronger than {threshold - h:g}, or raise resting_level above"
            f" {threshold - high:.3g}",
        )
    least = h + low + wiring.bounds[n.id].get("interaction", (0.0, 0.0))[0]
    if isinstance(e, RateNode):
        least = h + low + min(0.0, e.self_excitation)
    if least > threshold + CLEAR and n.reads["input"]:
        what = (
            f"is always above its threshold {threshold:g}: with its resting level {h:g} and its weakest input"
            f" ({low:g}) activation stays at {least:g} or above"
        )
        yield warning(
            n,
            what,
            f"Use a resting_level below {threshold - low:g}; resting levels are usually negative (-5)",
        )
    if h < threshold and isinstance(e.sigmoid, Logistic) and rest > AT_REST:
        what = (
            f"gives an output of {rest:.2g} at rest: with beta = {e.sigmoid.beta:g} its sigmoid is too flat"
            f" for a resting level of {h:g}"
        )
        yield warning(n, what, f"Use beta of {4 / (threshold - h):.2g} or more, or a lower resting_level")
    if isinstance(e, Field):
        white = not any(
            v for v in (e.noise_length if isinstance(e.noise_length, tuple) else (e.noise_length,))
        )
        deviation = e.noise / math.sqrt(2 * e.tau * (cell(tuple(e.axes)) if white else 1.0))
        if 0 < threshold - h < deviation:
            what = (
                "its noise alone brings it above its threshold: activation has a standard deviation of"
                f" {deviation:.2g}, and its resting level lies {threshold - h:g} below the threshold"
            )
            yield warning(n, what, f"Use noise below {e.noise * (threshold - h) / deviation / 4:.2g}")


def _waiting(wiring: Wiring, n: Node) -> Iterator[Problem]:
    e = n.element
    if not n.reads.get("input"):
        return
    _, most = wiring.arriving(n)
    if (
        isinstance(e, (MemoryTrace, Hebbian))
        and most <= e.threshold
        and not (isinstance(e, MemoryTrace) and e.graded)
    ):
        yield warning(
            n,
            f"learns nothing: its threshold is {e.threshold:g}, and what arrives is at most {most:g}",
            "Use a threshold of 0.5",
        )
    if isinstance(e, Threshold) and most <= e.level:
        yield warning(
            n,
            f"its input never exceeds its level {e.level:g}: it is at most {most:g}",
            f"Use a level below {most:g}",
        )
    if isinstance(e, (PeakPosition, RateCode)):
        axes = n.ins["input"] if isinstance(e, PeakPosition) else tuple(e.axes)
        whole = most * math.prod(a.step * a.samples for a in axes)
        if whole < e.least:
            what = (
                f"never finds a peak: least is {e.least:g}, and the integral of its input is at most"
                f" {whole:g}"
            )
            yield warning(
                n,
                what,
                "Use least far below the integral of one peak (its width times its height), such as"
                f" {whole / 100:.2g}",
            )
