"""Sums, products, factors and functions of each sample, and the register."""

from __future__ import annotations

from deodar.couplings.arithmetic import Gain, Product, Sigmoid, Sum
from deodar.couplings.delays import Delay
from deodar.couplings.projections import DiagonalSum, Project
from deodar.elements.stimuli import Boost, Pattern
from deodar.numerics.sigmoids import Absolute, Logistic, SemiLinear, SigmoidFunction, Step
from deodar_interop.exporters.cosivina.classes.kernels import shift_input
from deodar_interop.exporters.cosivina.classes.shapes import diagonal_sum, sum_dimension
from deodar_interop.exporters.cosivina.classes.stimuli import periods, timed_boosts
from deodar_interop.exporters.cosivina.draft import Given, Unwritable

STEEP = 1000.0
"""Steepness of the logistic sigmoid that stands for a step."""


def logistic(b: Given, found: SigmoidFunction) -> tuple[float, float]:
    """Return the steepness and the threshold of the logistic sigmoid that cosivina has.

    One with the same slope at the threshold stands for an `Absolute`, a steep one for a `Step`.
    """
    kind, threshold = type(found).__name__, float(getattr(found, "threshold", 0.0))
    if isinstance(found, Logistic):
        return found.beta, threshold
    if isinstance(found, (Absolute, Step)):
        beta = 2 * found.beta if isinstance(found, Absolute) else STEEP
        b.say("sigmoid", "approximated", f"cosivina has the Logistic; beta {beta:g} stands for the {kind}")
        b.approximate(f"a Logistic stands for its {kind}")
        return beta, threshold
    b.say("sigmoid", "dropped", f"cosivina has the Logistic alone; its default stands for the {kind}")
    b.approximate(f"its sigmoid is not the {kind}")
    return Logistic().beta, threshold


def gain(b: Given, element: Gain) -> None:
    """Write ScaleInput; with the sum before it, SumDimension or DiagonalSum."""
    factor = element.factor
    for before in b.draft.followers(b.id, "sum"):
        wires = b.draft.wires.into.get((b.id, "input"), [])
        if [c.source for c in wires] == [before.id] and b.draft.readers(before.id) == 1:
            if isinstance(before.element, Project) and before.element.reduce == "sum":
                return sum_dimension(b, before, factor)
            if isinstance(before.element, DiagonalSum):
                return diagonal_sum(b, before, factor)
    b.carry(b.sized("ScaleInput", {"amplitude": factor}))


def total(b: Given, element: Sum) -> None:
    """Write SumInputs; a sum of timed boosts, or of a shifted input and its border, is one element."""
    sources = [c.source for c in b.draft.wires.into.get((b.id, "input"), [])]
    named = b.draft.followers(b.id, "period")
    boosts = [e for e in named if isinstance(e.element, Boost) and e.element.windows is not None]
    if sources and sources == [e.id for e in boosts]:
        return timed_boosts(b, boosts)
    moved, border = b.draft.followers(b.id, "moved"), b.draft.followers(b.id, "border")
    if (
        len(moved) == len(border) == 1
        and sources == [moved[0].id, border[0].id]
        and isinstance(border[0].element, Pattern)
    ):
        return shift_input(b, moved[0], border[0])
    b.carry(b.sized("SumInputs", {}, sums=True))


def product(b: Given, element: Product) -> None:
    """Write PointwiseProduct; with a gate that opens at times, TimedSwitch."""
    wires = b.draft.wires.into.get((b.id, "factor"), [])
    for gate in b.draft.followers(b.id, "on"):
        opening = gate.element
        if (
            isinstance(opening, Boost)
            and opening.amplitude == 1
            and opening.windows is not None
            and [c.source for c in wires] == [gate.id]
            and b.draft.readers(gate.id) == 1
        ):
            b.claim([gate])
            part = b.sized("TimedSwitch", {"onTimes": periods(b, opening.windows)})
            b.carry(part)
            return
    part = b.sized("PointwiseProduct", {})
    ports = [c.target_port for c in b.draft.doc.connections if c.target == b.id]
    swapped = bool(ports) and ports[0] == "factor"  # the connections state the order of the inputs
    b.take(part, "input", int(swapped))
    b.take(part, "factor", int(not swapped))
    b.show(part)


def sigmoid(b: Given, element: Sigmoid) -> None:
    """Write Sigmoid or HalfWaveRectification."""
    found = element.sigmoid
    if found == SemiLinear(1.0, 0.0):
        part = b.sized("HalfWaveRectification", {})
    elif isinstance(found, (Logistic, Absolute, Step)):
        beta, threshold = logistic(b, found)
        part = b.sized("Sigmoid", {"beta": beta, "threshold": threshold})
    else:
        raise Unwritable(f"cosivina has no {type(found).__name__} of an input; it has the Logistic")
    b.carry(part)


def delay(b: Given, element: Delay) -> None:
    """Write a register: an element that passes its input on is read a step later by those before it."""
    part = b.sized("SumInputs", {}, sums=True)
    if element.initial:
        b.say("initial", "dropped", "cosivina begins with 0")
        b.approximate(f"it begins with 0, not with {element.initial:g}")
    b.carry(part)


KINDS = {Gain: gain, Sum: total, Product: product, Sigmoid: sigmoid, Delay: delay}
