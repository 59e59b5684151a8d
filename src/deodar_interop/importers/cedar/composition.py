"""A step of cedar as a function of its input signals: what it reads, and operations that add elements."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from deodar.couplings.arithmetic import Envelope, Gain, Pointwise, Product, Quotient, Sigmoid, Sum
from deodar.couplings.convolutions import Convolve
from deodar.couplings.delays import Delay
from deodar.couplings.weights import AxisWeights, Weights
from deodar.element import Element
from deodar.elements.stimuli import Boost
from deodar.importers.report import Verdict
from deodar.numerics.axes import Axis
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.sigmoids import Step
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers._piece import projection
from deodar_interop.importers.cedar.file import CedarStep
from deodar_interop.importers.cedar.grid import Counts, SampleGrid
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, StepPiece
from deodar_interop.importers.cedar.side_file import SideFile
from deodar_interop.importers.cedar.values import StepValues


@dc.dataclass(frozen=True)
class StepSignal:
    """A value inside a step: the port of an element, or what arrives at an input slot.

    Attributes:
        name: name of an element, or of an input slot.
        arriving_axes: its axes; None of an input from a step that cedar does not run.
        port: output port of the element.
        reads: what is read of a state: "" before the step, `current` after it.
        wire: which connection of an input slot it is; None of an element.
    """

    name: str
    arriving_axes: tuple[Axis, ...] | None
    port: str = "output"
    reads: str = ""
    wire: int | None = None

    @property
    def dims(self) -> Counts:
        """Its size.

        Raises:
            Refused: it is an input from a step that cedar does not run.
        """
        return tuple(axis.samples for axis in self.axes)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its axes; raises as `dims` does."""
        if self.arriving_axes is None:
            raise Refused(f"the step that feeds {self.name!r} does not run")
        return self.arriving_axes

    @property
    def updated(self) -> StepSignal:
        """The state after the step."""
        return dc.replace(self, reads="current")


class SourceStep:
    """One step of a file, and its translation, to which operations add elements and connections.

    An operation returns the output of its element; `role` is the element's name after that of the step, ""
    for the element that has the name of the step itself.

    Attributes:
        ins: sizes that arrive at each input slot, in the order of the connections; None of a step that cedar
            does not run.
        dt: step of the document, ms.
        met: known errors of cedar that this step touches.
    """

    def __init__(
        self,
        step: CedarStep,
        ins: Mapping[str, Sequence[Counts | None]],
        grid: SampleGrid,
        names: FreeNames,
        dt: float,
        stored: SideFile,
    ) -> None:
        self.step = step
        self.label = step.path[-1]
        self.values = StepValues(step.values, step.label)
        self.ins = ins
        self.grid = grid
        self.dt = dt
        self.met: list[str] = []
        self.piece = StepPiece()
        self._names = names
        self._stored = stored

    def stored(self, slot: str, shape: Counts) -> np.ndarray | None:
        """Return what the file stores of a slot; None without it. Another size is reported."""
        array = self._stored.of(self.step.label, slot, self.step.values)
        if array is None:
            return None
        size = tuple(n for n in shape if n > 1)
        if array.shape != size:
            why = f"it has the size {list(array.shape)}, not {list(size)}"
            self.values.say(f"stored {slot}", "dropped", why)
            return None
        self.values.say(f"stored {slot}", "carried", "as the value at the start")
        return array.reshape(shape)

    def axes(self, dims: Counts) -> tuple[Axis, ...]:
        """Return the axes of a size."""
        return self.grid.axes(dims)

    def named(self, role: str) -> str:
        """Return the name of a new element."""
        return self._names.new(f"{self.label} {role}") if role else self.label

    def bug(self, error: str) -> None:
        """Note a known error of cedar that this step touches, and that is corrected here."""
        self.met.append(f"{self.step.label}: {error}; corrected")

    def require_equal(self, first: StepSignal, second: StepSignal) -> None:
        """Raise Refused unless two signals have one size."""
        if first.dims != second.dims:
            raise Refused(f"the sizes {list(first.dims)} and {list(second.dims)} differ")

    def explain(self, why: str, verdict: Verdict = "carried") -> None:
        """Set the verdict and reason of the step in the report."""
        self.piece.why, self.piece.verdict = why, verdict

    # ------------------------------------------------------------------------------------------------- slots

    def arriving(self, name: str) -> StepSignal:
        """Return what arrives at an input slot, whatever its size.

        Raises:
            Refused: nothing arrives, or from a step that cedar does not run.
        """
        signal = self.optional(name)
        if signal is None:
            raise Refused(f"nothing is connected to {name!r}")
        self.piece.needs = (*self.piece.needs, name)
        return dc.replace(signal, arriving_axes=signal.axes)

    def optional(self, name: str, dims: Counts | None = None) -> StepSignal | None:
        """Return what arrives at an input slot that may be empty; None if it is. `dims` is the size that
        cedar requires, by default that of what arrives.
        """
        if name not in self.ins:
            return None
        counts = self.ins[name][0] if dims is None else dims
        if dims is not None:
            self.piece.wanted[name] = dims
        self.piece.inlets[name] = [[]]
        return StepSignal(name, None if counts is None else self.axes(counts), wire=0)

    def slot(self, name: str, dims: Counts, sums: bool = False) -> StepSignal:
        """Return what arrives at an input slot that requires a size; one that `sums` any number of
        connections may be empty.
        """
        self.piece.inlets[name] = [[]]
        self.piece.wanted[name] = dims
        if sums:
            self.piece.sums |= {name}
        else:
            self.piece.needs = (*self.piece.needs, name)
        return StepSignal(name, self.axes(dims), wire=0)

    def all_at(self, name: str) -> list[StepSignal]:
        """Return all that arrives at a slot, each of one size or one number.

        Raises:
            Refused: nothing arrives, or from a step that cedar does not run, or two sizes differ.
        """
        counts = self._arriving_sizes(name)
        self.piece.inlets[name] = [[] for _ in counts]
        return [StepSignal(name, self.axes(dims), wire=k) for k, dims in enumerate(counts)]

    def added(self, name: str) -> StepSignal:
        """Return the sum of all that arrives at a slot; raises as `all_at` does."""
        return self.slot(name, max(self._arriving_sizes(name), key=len), sums=True)

    def _arriving_sizes(self, name: str) -> list[Counts]:
        arriving = self.ins.get(name, ())
        if not arriving:
            raise Refused(f"nothing is connected to {name!r}")
        counts = [dims for dims in arriving if dims is not None]
        if len(counts) < len(arriving):
            raise Refused(f"a step that feeds {name!r} does not run")
        different = {dims for dims in counts if dims}
        if len(different) > 1:
            listed = ", ".join(map(str, map(list, different)))
            raise Refused(f"the inputs at {name!r} have different sizes: {listed}")
        return counts

    def outlet(self, slot: str, signal: StepSignal, state: bool = False, doubt: str = "") -> None:
        """Let an output slot show a signal."""
        self.piece.outlets[slot] = OutputSlot(signal.name, signal.dims, signal.port, state, doubt)

    # -------------------------------------------------------------------------------------------- operations

    def add(
        self, element: Element, axes: Sequence[Axis] | None = None, **ports: StepSignal | Sequence[StepSignal]
    ) -> StepSignal:
        """Add an element with its inputs; several signals at a port are added up. Without `axes` the output
        has those of the first input, or of the element.
        """
        self.piece.elements.append(element)
        inputs = [
            (port, signal)
            for port, signals in ports.items()
            for signal in ([signals] if isinstance(signals, StepSignal) else signals)
        ]
        if axes is None:
            axes = inputs[0][1].arriving_axes if inputs else getattr(element, "axes", ())
        output = StepSignal(element.name, None if axes is None else tuple(axes))
        for port, signal in inputs:
            self.connect(signal, output, port)
        return output

    def connect(self, signal: StepSignal, to: StepSignal, port: str = "input") -> None:
        """Connect a signal to a port of an element."""
        if signal.wire is not None:
            self.piece.inlets[signal.name][signal.wire].append(InputSlot(to.name, port))
        else:
            self.piece.inner.append((signal.name, to.name, port, signal.reads, signal.port))

    def constant(self, role: str, value: float, axes: Sequence[Axis] = ()) -> StepSignal:
        """Add one number."""
        return self.add(Boost(self.named(role), axes, value))

    def total(self, role: str, *signals: StepSignal) -> StepSignal:
        """Add a sum; the first signal has the axes of the sum."""
        return self.add(Sum(name=self.named(role)), input=signals)

    def copy(self, signal: StepSignal, why: str = "Sum, a copy") -> StepSignal:
        """Add a sum of one signal with the name of the step."""
        self.explain(why)
        return self.total("", signal)

    def gain(self, role: str, factor: float, *signals: StepSignal) -> StepSignal:
        """Add a multiple."""
        return self.add(Gain(factor, name=self.named(role)), input=signals)

    def product(self, role: str, first: StepSignal, second: StepSignal) -> StepSignal:
        """Add a product; the second signal may be one number."""
        return self.add(Product(name=self.named(role)), input=first, factor=second)

    def quotient(self, role: str, over: StepSignal, under: StepSignal, least: float) -> StepSignal:
        """Add a quotient; the divisor may be one number, and a smaller one than `least` is `least`."""
        return self.add(Quotient(least, name=self.named(role)), input=over, divisor=under)

    def limit(self, role: str, side: str, signal: StepSignal, other: StepSignal) -> StepSignal:
        """Add the larger (`upper`) or the smaller (`lower`) of two signals."""
        return self.add(Envelope(side, name=self.named(role)), input=signal, other=other)

    def function(self, role: str, function: str, *signals: StepSignal) -> StepSignal:
        """Add a function of each sample, by the names of `Pointwise`."""
        return self.add(Pointwise(function, name=self.named(role)), input=signals)

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

    def convolved(self, role: str, kernels: Sequence[Kernel], signal: StepSignal) -> StepSignal:
        """Add a convolution with the sum of kernels; of one number it is a multiple."""
        if signal.dims:
            return self.add(Convolve(kernels, name=self.named(role)), input=signal)
        return self.gain(role, sum(float(getattr(kernel, "amplitude", 0.0)) for kernel in kernels), signal)

    def weighted(
        self, role: str, weights: np.ndarray, axes: Sequence[Axis], signal: StepSignal
    ) -> StepSignal:
        """Add the product of a signal with weights, summed over its axes; `axes` are those of the output."""
        return self.add(Weights(weights, axes, name=self.named(role)), axes, input=signal)

    def turned(self, role: str, weights: np.ndarray, axis: Axis, signal: StepSignal, d: int) -> StepSignal:
        """Add the product of weights with a signal along its d-th axis, which becomes another axis."""
        axes = (*signal.axes[:d], axis, *signal.axes[d + 1 :])
        return self.add(
            AxisWeights(weights, axis, signal.axes[d].name, name=self.named(role)), axes, input=signal
        )

    def projected(
        self,
        role: str,
        signal: StepSignal,
        target: Sequence[Axis],
        places: Sequence[Axis | None],
        reduce: str = "sum",
    ) -> StepSignal:
        """Add a projection in which each axis of a signal becomes the axis at its index, or is reduced if
        that is None; axes of the target that remain are filled.
        """
        element = projection(self.named(role), signal.axes, tuple(target), places, reduce)
        return self.add(element, target, input=signal)

    def reduced(self, role: str, signal: StepSignal, reduce: str = "sum") -> StepSignal:
        """Add one number of a whole signal: its sum, or another reduction."""
        return self.projected(role, signal, (), [None] * len(signal.dims), reduce)


StepRule = Callable[..., "StepSignal | None"]
"""The translation of a step from what arrives at its slots: what its output slot shows, or None if it has
added its output slots itself.
"""


@dc.dataclass(frozen=True)
class StepKind:
    """A type of cedar's steps, and the function that translates it.

    Attributes:
        names: cedar's name of the type.
        rule: the translation.
        slots: input slots whose signals the function takes; one that ends in "?" may be empty, and is None
            then.
        gives: output slot that shows what the function returns.
        why: reason in the report; "" is the kind of the element with the step's name.
        sized: whether its outputs have sizes of their own, whatever arrives.
        looped: whether it has a state, which triggers call: all other types follow from these.
    """

    names: tuple[str]
    rule: StepRule
    slots: tuple[str, ...]
    gives: str
    why: str
    sized: bool
    looped: bool

    def __call__(self, s: SourceStep) -> StepPiece:
        """Return the translation of a step; the element with the name of the step is its first.

        Raises:
            Refused: cedar does not run it.
        """
        signals = [
            s.optional(slot.removesuffix("?")) if slot.endswith("?") else s.arriving(slot)
            for slot in self.slots
        ]
        output = self.rule(s, *signals)
        if output is not None:
            s.outlet(self.gives, output)
        s.piece.elements.sort(key=lambda element: element.name != s.label)
        s.piece.why = s.piece.why or self.why or type(s.piece.elements[0]).__name__
        return s.piece


def step(
    name: str, *slots: str, gives: str = "", why: str = "", sized: bool = False, looped: bool = False
) -> Callable[[StepRule], StepKind]:
    """Return the decorator that makes a function the translation of a type of steps; see `StepKind`."""
    return lambda rule: StepKind((name,), rule, slots, gives, why, sized, looped)
