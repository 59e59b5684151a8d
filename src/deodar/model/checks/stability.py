"""Loops that grow or spread, and competitions without a decision."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator

from deodar.couplings.arithmetic import Gain, Sum
from deodar.elements.field import Field
from deodar.elements.stimuli import BoxStimulus, GaussianStimulus
from deodar.errors import EditFix, Problem, assign, joined
from deodar.model.checks.activation import off_at_rest
from deodar.model.checks.noise import correlated
from deodar.model.checks.resolution import fix_with_cells
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.sigmoids import Linear, SemiLinear
from deodar.proposed_edit import SetValues, rounded

LONGEST = 12
"""Largest number of elements of a linear loop."""

CALM = 0.9
"""Product of the gains of a loop after its fix (a guess)."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Report growth of linear loops, fronts that spread without limit, and ties without noise."""
    reported: set[str] = set()
    for n in wiring.declared:
        e = n.element
        if _slope(n) and n.id not in reported:
            loop = _growing(wiring, n)
            if loop:
                reported |= {m.id for m, _ in loop}
                gain = math.prod(g for _, g in loop)
                names = " -> ".join([m.path for m, _ in loop] + [n.path])
                sentence = (
                    f"grows without bound: once round the loop {names} a signal is multiplied by {gain:.3g}"
                )
                yield warning(n, sentence, _weaker(loop, gain))
        if isinstance(e, Field) and e.axes:
            yield from _spread(wiring, n, e)
            yield from _tie(wiring, n, e)


def _slope(n: Node) -> float:
    """Return the factor by which an element multiplies a steady signal, if it is linear; else 0."""
    e = n.element
    if isinstance(e, Gain):
        return e.factor
    if isinstance(e, Sum) or not n.declared:
        return 1.0 if len(n.ins.get("input", ())) == len(n.outs.get("output", ())) else 0.0
    if isinstance(e, Field) and isinstance(e.sigmoid, (Linear, SemiLinear)):
        return e.sigmoid.slope
    return 0.0


def _growing(wiring: Wiring, start: Node) -> list[tuple[Node, float]]:
    """Return a loop from a node back to itself whose gain is above 1: its own kernel, or through others."""
    e = start.element
    if isinstance(e, Field) and isinstance(e.sigmoid, (Linear, SemiLinear)):
        parts = [kernel.bounds(tuple(e.axes)) for kernel in e.kernel]
        gain = e.sigmoid.slope * (
            sum(a + b for a, b in parts) - e.global_inhibition * math.prod(a.step * a.samples for a in e.axes)
        )
        border = 1.2 if e.axes else 1.0  # a part of the kernel is lost near a border
        if border < gain < math.inf:
            return [(start, gain)]
    paths: list[tuple[list[tuple[Node, float]], float]] = [([(start, _slope(start))], _slope(start))]
    while paths:
        path, gain = paths.pop()
        for i in wiring.readers[path[-1][0].id]:
            n = wiring.nodes[i]
            if n is start and gain > 1:
                return [(m, g) for m, g in path if m.declared]
            if _slope(n) > 0 and n not in [m for m, _ in path] and len(path) < LONGEST:
                paths.append(([*path, (n, _slope(n))], gain * _slope(n)))
    return []


def _weaker(loop: list[tuple[Node, float]], gain: float) -> str:
    """Return the fix for a loop that grows: a smaller factor of one of its elements."""
    advice = "Make the product of its gains smaller than 1"
    saturate = "Or take a sigmoid that saturates, such as Logistic"
    for n, _ in loop:
        e = n.element
        path, factor = (
            ("factor", e.factor)
            if isinstance(e, Gain)
            else ("sigmoid.slope", e.sigmoid.slope)
            if isinstance(e, Field) and isinstance(e.sigmoid, (Linear, SemiLinear))
            else ("", 0.0)
        )
        if path:
            smaller = SetValues(((path, rounded(CALM * factor / gain)),), n.path)
            return EditFix(advice, [smaller], saturate)
    return joined(advice, saturate)


def _spread(wiring: Wiring, n: Node, e: Field) -> Iterator[Problem]:
    """Report a wide peak that spreads.

    The edge of a wide peak gets half the kernel: where that raises it above the threshold without inhibition,
    the peak widens to the ends of the axis.
    """
    if isinstance(e.sigmoid, (Linear, SemiLinear)) or wiring.arriving(n)[0] < 0:
        return
    parts = [kernel.bounds(tuple(e.axes)) for kernel in e.kernel]
    threshold: float = getattr(e.sigmoid, "threshold", 0.0)
    whole = math.prod(a.step * a.samples for a in e.axes)
    edge = e.resting_level + sum(b for _, b in parts) / 2 - threshold
    if any(a for a, _ in parts) or not 0 < edge < math.inf or e.global_inhibition * whole > 0.5 * edge:
        return
    sentence = (
        "a peak in it spreads over the whole field: half of its kernel's integral"
        f" ({sum(b for _, b in parts) / 2:.3g}) exceeds the resting level {e.resting_level:g}, and nothing"
        " inhibits distant positions"
    )
    yield warning(
        n,
        sentence,
        _inhibited(wiring, n, e, edge),
    )


def _inhibited(wiring: Wiring, n: Node, e: Field, edge: float) -> str:
    """Return the fix for a peak that spreads: global inhibition, and a resting level that ends it."""
    advice, otherwise = "Give it global inhibition", "Or give it a MexicanHat or a weaker kernel"
    values = off_at_rest(wiring, n, e)
    if e.resting_level >= getattr(e.sigmoid, "threshold", 0.0) and not values:
        return joined(f"{advice}, and a resting level below its threshold", otherwise)
    edge += values.get("resting_level", e.resting_level) - e.resting_level
    if edge > 0:
        values["global_inhibition"] = rounded(edge / (0.2 * math.prod(a.step * a.samples for a in e.axes)))
    return fix_with_cells(wiring, e, assign(advice, values, otherwise))


def _tie(wiring: Wiring, n: Node, e: Field) -> Iterator[Problem]:
    """Report a selection between equal inputs without noise, which rounding of the last digit would
    decide.
    """
    sources = wiring.sources(n)
    if e.noise > 0 or e.global_inhibition <= 0 or len(sources) < 2:
        return
    inputs = sorted(sources, key=lambda m: wiring.position[m.id])
    same = {
        dc.replace(m.element, name="", center=0.0)
        for m in inputs
        if isinstance(m.element, (GaussianStimulus, BoxStimulus))
    }
    if len(same) == 1 and all(isinstance(m.element, (GaussianStimulus, BoxStimulus)) for m in inputs):
        sentence = (
            f"its inputs {' and '.join(m.path for m in inputs)} are equal, they compete, and noise is 0:"
            " rounding decides which one wins"
        )
        length = correlated(dc.replace(e, noise=0.1)) if e.quadrature == "cell" else {}
        noise = {"noise": 0.1, **length}
        yield warning(n, sentence, assign("Give it noise", noise, "Or make one input stronger"))
