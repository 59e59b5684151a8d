"""The context of the translation of one element of a list, and operations that add elements to it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet

from deodar.couplings.projections import Project
from deodar.element import Element
from deodar.importers.report import Verdict
from deodar.numerics.axes import Axis
from deodar_interop.importers._axes import LengthAxes
from deodar_interop.importers._foreign import Foreign, FreeNames
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, axes, projection


@dc.dataclass(frozen=True)
class ElementSignal:
    """A value inside the translation of an element: the port of a deodar element, or an input of the file.

    Attributes:
        name: name of an element; "" of an input.
        dims: its dimensions.
        port: output port of the element.
        entry: which input it is; None of an element.
        whole: whether an input must have all of its dimensions.
        component: the component to read if it differs from the file's.
    """

    name: str
    dims: Dims
    port: str = "output"
    entry: int | None = None
    whole: bool = False
    component: str = ""

    def at(self, port: str) -> ElementSignal:
        """Return another port of the element."""
        return dc.replace(self, port=port)


class FileElement:
    """One element of a file, and its translation, to which operations add elements and connections.

    An operation returns the output of its element; `role` is the element's name after the label, "" for the
    element that has the label itself.

    Attributes:
        element, label: the element, and its name.
        step: the Euler step.
        components_read: components that other elements read.
        piece: the translation.
        met: known errors of the tool that it touches.
    """

    def __init__(
        self,
        element: Foreign,
        step: float,
        length_axes: LengthAxes,
        components_read: AbstractSet[str],
        names: FreeNames,
    ) -> None:
        self.element = element
        self.label = element.label
        self.step = step
        self.components_read = components_read
        self.piece = Piece()
        self.met: list[str] = []
        self._axes = length_axes
        self._names = names

    def of(self, counts: Sequence[int]) -> Dims:
        """Return the dimensions of a size."""
        return self._axes.of(counts)

    def named(self, role: str) -> str:
        """Return the name of a new element."""
        return self._names.new(f"{self.label} {role}") if role else self.label

    def explain(self, why: str, verdict: Verdict = "carried") -> None:
        """Set the verdict and reason of the element in the report."""
        self.piece.why, self.piece.verdict = why, verdict

    def input(self, dims: Dims, whole: bool = True, needed: bool = True, sums: bool = False) -> ElementSignal:
        """Return the next input of the file.

        Args:
            dims: its dimensions.
            whole: whether it must have all of them.
            needed: whether zero arrives if the file connects nothing to it.
            sums: whether it adds up all inputs.
        """
        entry = len(self.piece.inlets)
        self.piece.inlets.append([])
        self.piece.sums |= sums
        if needed:
            self.piece.needs = entry + 1
        return ElementSignal("", dims, entry=entry, whole=whole)

    def outlet(
        self,
        component: str,
        signal: ElementSignal,
        state: bool = False,
        still: bool = False,
        noise: bool = False,
        initial: float = 0.0,
    ) -> None:
        """Let a component show a signal; see `Outlet`."""
        outlet = Outlet(signal.name, signal.dims, signal.port, state, still, noise, initial)
        self.piece.outlets[component] = outlet

    def add(
        self, element: Element, dims: Dims | None = None, **ports: ElementSignal | Sequence[ElementSignal]
    ) -> ElementSignal:
        """Add an element with its inputs; several signals at a port are added up. Without `dims` the output
        has those of the first input.
        """
        self.piece.elements.append(element)
        inputs = [
            (port, signal)
            for port, signals in ports.items()
            for signal in ([signals] if isinstance(signals, ElementSignal) else signals)
        ]
        output = ElementSignal(element.name, inputs[0][1].dims if dims is None else dims)
        for port, signal in inputs:
            self.connect(signal, output, port)
        return output

    def connect(self, signal: ElementSignal, to: ElementSignal, port: str = "input") -> None:
        """Connect a signal to a port of an element."""
        if signal.entry is not None:
            inlet = Inlet(to.name, signal.dims, port, signal.whole, signal.component)
            self.piece.inlets[signal.entry].append(inlet)
        else:
            self.piece.inner.append((signal.name, to.name, port))

    def projected(
        self,
        role: str,
        signal: ElementSignal,
        target: Dims,
        places: Sequence[Axis | None],
        reduce: str = "sum",
    ) -> ElementSignal:
        """Add a projection in which each axis of a signal becomes the axis at its index, or is reduced if
        that is None; axes of the target that remain are filled.
        """
        element: Project = projection(self.named(role), axes(signal.dims), target, places, reduce)
        return self.add(element, target, input=signal)


ElementRule = Callable[..., ElementSignal | None]
"""The translation of an element: what its output shows, or None if it has added its outlets itself."""


@dc.dataclass(frozen=True)
class ElementKind:
    """Classes of a tool, and the function that translates their elements.

    Attributes:
        names: the tool's names of the classes.
        rule: the translation.
    """

    names: tuple[str, ...]
    rule: ElementRule

    def __call__(self, b: FileElement) -> Piece:
        """Return the translation of an element; the element with its label is the first."""
        output = self.rule(b)
        if output is not None:
            b.outlet("output", output)
        b.piece.elements.sort(key=lambda element: element.name != b.label)
        b.piece.why = b.piece.why or type(b.piece.elements[0]).__name__
        return b.piece


def translates(*names: str) -> Callable[[ElementRule], ElementKind]:
    """Return the decorator that makes a function the translation of classes of a tool."""
    return lambda rule: ElementKind(names, rule)
