"""Programming: copies, counts, switches, positions, delays and signals of time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.delay import Delay
from deodar.couplings.delay_line import DelayLine
from deodar.couplings.envelope import Envelope
from deodar.couplings.gain import Gain
from deodar.couplings.maximum_position import MaximumPosition
from deodar.couplings.pointwise import Pointwise
from deodar.couplings.product import Product
from deodar.couplings.project import Project
from deodar.couplings.rate_code import RateCode
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.sum import Sum
from deodar.couplings.threshold import Threshold
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.integrator import Integrator
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids.step import Step
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.algebra import one_to_one
from deodar_interop.importers.cedar.classes.numerics import SECOND
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, Refused, SourceStep, StepPiece

FLOAT_TYPES = ("Float", "Double")

LOWEST = -1e30
"""Maximum before the first input: less than any input."""

LEAST = 1e-9
"""Sum of an input up to which there is no peak."""


def noop(b: SourceStep) -> StepPiece:
    """Translate Noop and NoopLooped."""
    return one_to_one(Sum(name=b.label), "input", "output", b.first("input"), why="Sum, a copy")


def buffer_reader(b: SourceStep) -> StepPiece:
    """Translate BufferReader, of the activation of a field."""
    b.values.say("buffer path")
    if "buffer" not in b.ins:
        raise Unfit("deodar's port of this buffer is not the same: only the activation of a field is")
    return one_to_one(Sum(name=b.label), "buffer", "buffer value", b.first("buffer"), why="Sum, a copy")


def converter(b: SourceStep) -> StepPiece:
    """Translate MatrixTypeConverter; all numbers are real here."""
    piece = one_to_one(Sum(name=b.label), "matrix", "converted matrix", b.first("matrix"), why="Sum, a copy")
    kind = b.values.word("target type", "Float")
    if kind not in FLOAT_TYPES:
        b.values.say("target type", "approximated", "numbers are not rounded")
    return piece


def nan_check(b: SourceStep) -> StepPiece:
    """Translate NaNCheck: a run with undefined values ends with an error here."""
    for name in ("check for NaN?", "check for Inf?", "check for Empty?", "automatically reset"):
        if name in b.values.body:
            b.values.say(name, "carried", "a run with undefined values ends with an error")
    return one_to_one(Sum(name=b.label), "input", "output", b.first("input"), why="Sum, a copy")


def count(b: SourceStep) -> StepPiece:
    """Translate Count: the number of samples above a threshold."""
    b.first("input")
    above = Sigmoid(Step(b.values.number("threshold", 0.0)), name=b.named("above"))
    return StepPiece(
        [Project([], "sum", name=b.label), above],
        {"input": [[InputSlot(above.name)]]},
        {"output": OutputSlot(b.label, ())},
        [(above.name, b.label)],
        needs=("input",),
        why="Sigmoid with Step, summed",
    )


def switch(b: SourceStep) -> StepPiece:
    """Translate Switch: a mixture of two inputs."""
    first, second, factor = b.first("input 1"), b.first("input 2"), b.first("factor")
    if first != second or factor not in ((), first):
        raise Refused(f"the sizes {list(first)}, {list(second)} and {list(factor)} do not fit")
    first_part, second_part, remainder, minus, unit = (
        b.named(w) for w in ("first part", "second part", "rest", "minus", "one")
    )
    piece = StepPiece(
        [
            Sum(name=b.label),
            Product(name=first_part),
            Product(name=second_part),
            Sum(name=remainder),
            Gain(-1.0, name=minus),
            Boost(unit, (), 1.0),
        ],
        {
            "input 1": [[InputSlot(first_part)]],
            "input 2": [[InputSlot(second_part)]],
            "factor": [[InputSlot(first_part, "factor"), InputSlot(minus)]],
        },
        {"mixture": OutputSlot(b.label, first)},
        [
            (first_part, b.label),
            (second_part, b.label),
            (minus, remainder),
            (unit, remainder),
            (remainder, second_part, "factor"),
        ],
        needs=("input 1", "input 2", "factor"),
        why="two Product, summed",
    )
    if b.values.flag("make binary", False):
        binary = Sigmoid(Step(0.5), name=b.named("binary"))
        piece.elements.append(binary)
        piece.inlets["factor"] = [[InputSlot(binary.name)]]
        piece.inner += [(binary.name, first_part, "factor"), (binary.name, minus)]
    return piece


def position(b: SourceStep) -> StepPiece:
    """Translate PositionOfMaximum: of the largest sample, or the mean of what is above a threshold."""
    dims = b.first("input")
    if not dims:
        raise Refused("its input is one number")
    kind = b.values.word("position type", "Maximum", ("Maximum", "Centroid", "Cyclic Mean"))
    least = b.values.number("Peak detection threshold", 0.1)
    above = b.values.number("Centroid detection threshold", 0.1)
    if b.values.flag("NaN if no peak", False):
        b.values.say("NaN if no peak", "approximated", "0 is given")
    axes, many = b.axes(dims), len(dims) > 1
    name = b.named("of all axes") if many else b.label
    element: Element = MaximumPosition(least, name=name)
    if kind != "Maximum":
        turns = [Axis(f"turn {a.name}", 0, a.samples, a.samples, periodic=True) for a in axes]
        element = RateCode(turns if kind == "Cyclic Mean" else list(axes), least=LEAST, name=name)
    piece = one_to_one(element, "input", "output", (len(dims),) if many else ())
    if many:
        # the numbers are along an axis of their own, which cedar calls the first dimension
        axis = b.axes((len(dims),))[0]
        piece.elements.insert(0, Project([axis], "sum", {"component": axis.name}, name=b.label))
        piece.inner.append((name, b.label))
        piece.outlets["output"] = OutputSlot(b.label, (len(dims),))
    if kind == "Centroid":
        over = Threshold(above, name=b.named("above the threshold"))
        piece.elements.append(over)
        piece.inner.append((over.name, name))
        piece.inlets["input"] = [[InputSlot(over.name)]]
    if isinstance(element, RateCode) and kind == "Cyclic Mean":
        _on_rings(b, piece, element, axes)
    return piece


def _on_rings(b: SourceStep, piece: StepPiece, element: RateCode, axes: Sequence[Axis]) -> None:
    """Let a read-out see its input over whole turns, as cedar's cyclic mean does, whatever the border."""
    last = element.name
    for axis, turn in zip(axes, element.axes, strict=True):
        ring = AxisWeights(np.eye(axis.samples), turn, axis.name, name=b.named(f"ring of {axis.name}"))
        piece.elements.append(ring)
        piece.inner.append((ring.name, last))
        last = ring.name
    piece.inlets["input"] = [[InputSlot(last)]]


def delay(b: SourceStep) -> StepPiece:
    """Translate Delay: a number of steps."""
    dims = b.first("input")
    steps = b.values.whole("number of time steps", 1, 1, 100_000)
    line = DelayLine(b.label, b.axes(dims), steps * b.dt, steps)
    piece = one_to_one(line, "input", "output", dims)
    return piece


def over_time(b: SourceStep) -> StepPiece:
    """Translate OverTime: the largest input so far, at each sample."""
    dims, c = b.first("input"), Composition(b)
    before = Delay(b.axes(dims), LOWEST, name=b.named("before"))
    largest = c.add(Envelope("upper", name=b.label), input=c.slot("input"), other=StepSignal(before.name))
    c.add(before, input=largest)
    c.outlet("output", largest, dims)
    why = "Envelope of its input and its last output; that a run begins with its first input is a guess"
    return c.done(why, "approximated")


def sinus_signal(b: SourceStep) -> StepPiece:
    """Translate SinusSignal: A sin((t + phase) / period 2 pi) + offset, t in s."""
    return _signal(b, "cos" if b.values.flag("make cos", False) else "sin")


def step_signal(b: SourceStep) -> StepPiece:
    """Translate StepSignal: a wave of two values."""
    b.values.flag("make cos", False)
    piece = _signal(b, "sin")
    wave, sign = piece.elements[2], Sigmoid(Step(0.0), name=b.named("sign"))
    gain = piece.elements[1]
    amplitude = float(getattr(gain, "factor", 1.0))
    piece.elements[1] = Gain(2 * amplitude, name=gain.name)
    piece.elements += [sign, Boost(b.named("lower"), (), -amplitude)]
    piece.inner = [w for w in piece.inner if w[:2] != (wave.name, gain.name)]
    piece.inner += [(wave.name, sign.name), (sign.name, gain.name), (piece.elements[-1].name, b.label)]
    piece.verdict, piece.why = "approximated", "the sign of a sine: cedar's wave is not documented"
    return piece


def _signal(b: SourceStep, function: str) -> StepPiece:
    period = b.values.number("period", 1.0)
    if not period:
        raise Refused("its period is 0")
    phase, offset = b.values.number("phase shift", 0.0), b.values.number("vertical offset", 0.0)
    gain = Gain(b.values.number("amplitude", 1.0), name=b.named("amplitude"))
    wave = Pointwise(function, name=b.named(function))
    angle = Gain(2 * math.pi / period, name=b.named("angle"))
    clock, unit = Integrator(b.named("time"), (), SECOND, initial=phase), Boost(b.named("one"), (), 1.0)
    raised = Boost(b.named("offset"), (), offset)
    return StepPiece(
        [Sum(name=b.label), gain, wave, angle, clock, unit, raised],
        outlets={"signal": OutputSlot(b.label, ())},
        inner=[
            (gain.name, b.label),
            (raised.name, b.label),
            (wave.name, gain.name),
            (angle.name, wave.name),
            (clock.name, angle.name, "input", "current"),
            (unit.name, clock.name),
        ],
        why="Integrator as clock, and Pointwise",
    )


CLASSES = {
    "cedar.processing.steps.Noop": noop,
    "cedar.processing.steps.NoopLooped": noop,
    "cedar.processing.steps.BufferReader": buffer_reader,
    "cedar.processing.steps.MatrixTypeConverter": converter,
    "cedar.processing.steps.NaNCheck": nan_check,
    "cedar.processing.steps.Count": count,
    "cedar.processing.steps.Switch": switch,
    "cedar.processing.steps.PositionOfMaximum": position,
    "cedar.processing.steps.Delay": delay,
    "cedar.processing.steps.OverTime": over_time,
    "cedar.processing.sources.SinusSignal": sinus_signal,
    "cedar.processing.sources.StepSignal": step_signal,
}

DECLARED = frozenset({"cedar.processing.sources.SinusSignal", "cedar.processing.sources.StepSignal"})

LOOPED = frozenset(
    {
        "cedar.processing.sources.SinusSignal",
        "cedar.processing.sources.StepSignal",
        "cedar.processing.steps.NoopLooped",
    }
)
