"""A step as an expression of couplings: signals, and operations that connect them to new elements."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.delay import Delay
from deodar.couplings.envelope import Envelope
from deodar.couplings.gain import Gain
from deodar.couplings.pointwise import Pointwise
from deodar.couplings.product import Product
from deodar.couplings.quotient import Quotient
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.sum import Sum
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.importers.report import Verdict
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids.step import Step
from deodar_interop.importers._piece import projection
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, SourceStep, StepPiece


@dc.dataclass(frozen=True)
class StepSignal:
    """A value inside a step: the port of an element, or all that arrives at an input slot.

    Attributes:
        name: name of an element, or of an input slot.
        port: output port of the element.
        reads: what is read of a state: "" before the step, `current` after it.
        slot: whether it is an input slot.
    """

    name: str
    port: str = "output"
    reads: str = ""
    slot: bool = False


class Composition:
    """The elements of one step and the connections among them, from which its translation follows.

    An operation adds an element and returns its output; `what` is the element's name after that of the step,
    "" for the element that has the name of the step itself.
    """

    def __init__(self, b: SourceStep) -> None:
        self.b = b
        self.piece = StepPiece()

    def slot(self, name: str, dims: Counts | None = None, optional: bool = False) -> StepSignal:
        """Return what arrives at an input slot; `dims` is the size that cedar requires."""
        self.piece.inlets[name] = [[]]
        if dims is not None:
            self.piece.wanted[name] = dims
        if not optional:
            self.piece.needs = (*self.piece.needs, name)
        return StepSignal(name, slot=True)

    def named(self, role: str) -> str:
        """Return the name of a new element."""
        return self.b.named(role) if role else self.b.label

    def add(self, element: Element, **ports: StepSignal | Sequence[StepSignal]) -> StepSignal:
        """Add an element with its inputs; several signals at a port are added up."""
        self.piece.elements.append(element)
        for port, sources in ports.items():
            for signal in (sources,) if isinstance(sources, StepSignal) else sources:
                self.connect(signal, element.name, port)
        return StepSignal(element.name)

    def connect(self, signal: StepSignal, name: str, port: str = "input") -> None:
        """Connect a signal to a port of an element."""
        if signal.slot:
            self.piece.inlets[signal.name][0].append(InputSlot(name, port))
        else:
            self.piece.inner.append((signal.name, name, port, signal.reads, signal.port))

    def constant(self, role: str, value: float) -> StepSignal:
        """Add one number."""
        return self.add(Boost(self.named(role), (), value))

    def total(self, role: str, *signals: StepSignal) -> StepSignal:
        """Add a sum; the first signal has the axes of the sum."""
        return self.add(Sum(name=self.named(role)), input=signals)

    def gain(self, role: str, factor: float, signal: StepSignal) -> StepSignal:
        """Add a multiple."""
        return self.add(Gain(factor, name=self.named(role)), input=signal)

    def product(self, role: str, first: StepSignal, second: StepSignal) -> StepSignal:
        """Add a product; the second signal may be one number."""
        return self.add(Product(name=self.named(role)), input=first, factor=second)

    def quotient(self, role: str, over: StepSignal, under: StepSignal, least: float) -> StepSignal:
        """Add a quotient; the divisor may be one number, and a smaller one than `least` is `least`."""
        return self.add(Quotient(least, name=self.named(role)), input=over, divisor=under)

    def limit(self, role: str, side: str, signal: StepSignal, other: StepSignal) -> StepSignal:
        """Add the larger (`upper`) or the smaller (`lower`) of two signals."""
        return self.add(Envelope(side, name=self.named(role)), input=signal, other=other)

    def function(self, role: str, function: str, signal: StepSignal) -> StepSignal:
        """Add a function of each sample, by the names of `Pointwise`."""
        return self.add(Pointwise(function, name=self.named(role)), input=signal)

    def above(self, role: str, threshold: float, signal: StepSignal) -> StepSignal:
        """Add 1 where a signal is larger than a threshold, else 0."""
        return self.add(Sigmoid(Step(threshold), name=self.named(role)), input=signal)

    def below(self, role: str, threshold: float, signal: StepSignal) -> StepSignal:
        """Add 1 where a signal is smaller than a threshold, else 0."""
        return self.above(role, -threshold, self.gain(f"minus {role}", -1.0, signal))

    def rest(self, role: str, signal: StepSignal) -> StepSignal:
        """Add 1 minus a signal."""
        return self.total(role, self.gain(f"minus {role}", -1.0, signal), self.constant(f"one {role}", 1.0))

    def before(self, role: str, signal: StepSignal, axes: Sequence[Axis] = ()) -> StepSignal:
        """Add the value of a signal in the last step; 0 in the first."""
        return self.add(Delay(tuple(axes), name=self.named(role)), input=signal)

    def started(self) -> StepSignal:
        """Add 0 in the first step and 1 from then on."""
        return self.before("started", self.constant("one at the start", 1.0))

    def projected(
        self,
        role: str,
        signal: StepSignal,
        source: Sequence[Axis],
        target: Sequence[Axis],
        places: Sequence[Axis | None],
        reduce: str = "sum",
    ) -> StepSignal:
        """Add a projection in which each axis of the source becomes the axis at its index, or is reduced if
        that is None; axes of the target that remain are filled.
        """
        return self.add(projection(self.named(role), source, tuple(target), places, reduce), input=signal)

    def outlet(
        self, slot: str, signal: StepSignal, dims: Counts, state: bool = False, doubt: str = ""
    ) -> None:
        """Let an output slot show a signal."""
        self.piece.outlets[slot] = OutputSlot(signal.name, dims, signal.port, state, doubt)

    def done(self, why: str, verdict: Verdict = "carried") -> StepPiece:
        """Return the translation; the element with the name of the step is its first."""
        self.piece.elements.sort(key=lambda element: element.name != self.b.label)
        self.piece.why, self.piece.verdict = why, verdict
        return self.piece
