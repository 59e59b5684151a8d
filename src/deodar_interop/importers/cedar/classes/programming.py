"""Programming: copies, counts, switches, positions, delays and signals of time."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.arithmetic import Threshold
from deodar.couplings.delays import Delay, DelayLine
from deodar.couplings.positions import MaximumPosition, RateCode
from deodar.elements.variables import Integrator
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.classes.numerics import SECOND
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.piece import Refused

FLOAT_TYPES = ("Float", "Double")

LOWEST = -1e30
"""Maximum before the first input: less than any input."""

LEAST = 1e-9
"""Sum of an input up to which there is no peak."""


def copied(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Noop and NoopLooped."""
    return s.copy(seen)


noop = step("cedar.processing.steps.Noop", "input", gives="output")(copied)
looped_noop = step("cedar.processing.steps.NoopLooped", "input", gives="output", looped=True)(copied)


@step("cedar.processing.steps.BufferReader", "buffer?", gives="buffer value")
def buffer_reader(s: SourceStep, buffer: StepSignal | None) -> StepSignal:
    """Translate BufferReader, of the activation of a field."""
    s.values.say("buffer path")
    if buffer is None:
        raise Unfit("deodar's port of this buffer is not the same: only the activation of a field is")
    return s.copy(buffer)


@step("cedar.processing.steps.MatrixTypeConverter", "matrix", gives="converted matrix")
def converter(s: SourceStep, matrix: StepSignal) -> StepSignal:
    """Translate MatrixTypeConverter; all numbers are real here."""
    if s.values.word("target type", "Float") not in FLOAT_TYPES:
        s.values.say("target type", "approximated", "numbers are not rounded")
    return s.copy(matrix)


@step("cedar.processing.steps.NaNCheck", "input", gives="output")
def nan_check(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate NaNCheck: a run with undefined values ends with an error here."""
    for name in ("check for NaN?", "check for Inf?", "check for Empty?", "automatically reset"):
        if name in s.values.body:
            s.values.say(name, "carried", "a run with undefined values ends with an error")
    return s.copy(seen)


@step("cedar.processing.steps.Count", "input", gives="output", why="Sigmoid with Step, summed")
def count(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Count: the number of samples above a threshold."""
    return s.reduced("", s.above("above", s.values.number("threshold", 0.0), seen))


@step(
    "cedar.processing.steps.Switch",
    "input 1",
    "input 2",
    "factor",
    gives="mixture",
    why="two Product, summed",
)
def switch(s: SourceStep, first: StepSignal, second: StepSignal, factor: StepSignal) -> StepSignal:
    """Translate Switch: a mixture of two inputs."""
    if first.dims != second.dims or factor.dims not in ((), first.dims):
        sizes = f"{list(first.dims)}, {list(second.dims)} and {list(factor.dims)}"
        raise Refused(f"the sizes {sizes} do not fit")
    if s.values.flag("make binary", False):
        factor = s.above("binary", 0.5, factor)
    second_part = s.product("second part", second, s.rest("rest", factor))
    return s.total("", s.product("first part", first, factor), second_part)


@step("cedar.processing.steps.PositionOfMaximum", "input", gives="output")
def position(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate PositionOfMaximum: of the largest sample, or the mean of what is above a threshold."""
    axes = seen.axes
    if not axes:
        raise Refused("its input is one number")
    kind = s.values.word("position type", "Maximum", ("Maximum", "Centroid", "Cyclic Mean"))
    least = s.values.number("Peak detection threshold", 0.1)
    above = s.values.number("Centroid detection threshold", 0.1)
    if s.values.flag("NaN if no peak", False):
        s.values.say("NaN if no peak", "approximated", "0 is given")
    if kind == "Centroid":
        seen = s.add(Threshold(above, name=s.named("above the threshold")), input=seen)
    if kind == "Cyclic Mean":
        # over whole turns, whatever the border
        for d, axis in reversed([*enumerate(axes)]):
            turn = Axis(f"turn {axis.name}", 0, axis.samples, axis.samples, periodic=True)
            seen = s.turned(f"ring of {axis.name}", np.eye(axis.samples), turn, seen, d)
    name = s.named("of all axes" if len(axes) > 1 else "")
    read_out = (
        MaximumPosition(least, name=name)
        if kind == "Maximum"
        else RateCode(seen.axes, least=LEAST, name=name)
    )
    if len(axes) == 1:
        return s.add(read_out, (), input=seen)
    s.explain(type(read_out).__name__)
    # the numbers are along an axis of their own, which cedar calls the first dimension
    component = Axis("component", 0, len(axes) - 1, len(axes))
    target_axes = s.axes((len(axes),))
    return s.projected("", s.add(read_out, [component], input=seen), target_axes, target_axes)


@step("cedar.processing.steps.Delay", "input", gives="output")
def delay(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate Delay: a number of steps."""
    steps = s.values.whole("number of time steps", 1, 1, 100_000)
    return s.add(DelayLine(s.label, seen.axes, steps * s.dt, steps), input=seen)


@step("cedar.processing.steps.OverTime", "input", gives="output")
def over_time(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate OverTime: the largest input so far, at each sample."""
    before = s.add(Delay(seen.axes, LOWEST, name=s.named("before")))
    largest = s.limit("", "upper", seen, before)
    s.connect(largest, before)
    why = "Envelope of its input and its last output; that a run begins with its first input is a guess"
    s.explain(why, "approximated")
    return largest


CLOCKED = "Integrator as clock, and Pointwise"


@step("cedar.processing.sources.SinusSignal", gives="signal", why=CLOCKED, sized=True, looped=True)
def sinus_signal(s: SourceStep) -> StepSignal:
    """Translate SinusSignal: A sin((t + phase) / period 2 pi) + offset, t in s."""
    wave, offset = _wave(s, "cos" if s.values.flag("make cos", False) else "sin"), _offset(s)
    return s.total("", s.gain("amplitude", s.values.number("amplitude", 1.0), wave), offset)


@step("cedar.processing.sources.StepSignal", gives="signal", sized=True, looped=True)
def step_signal(s: SourceStep) -> StepSignal:
    """Translate StepSignal: a wave of two values."""
    s.values.flag("make cos", False)
    sign, offset = s.above("sign", 0.0, _wave(s, "sin")), _offset(s)
    amplitude = s.values.number("amplitude", 1.0)
    s.explain("the sign of a sine: cedar's wave is not documented", "approximated")
    return s.total("", s.gain("amplitude", 2 * amplitude, sign), offset, s.constant("lower", -amplitude))


def _wave(s: SourceStep, function: str) -> StepSignal:
    """Return a function of the time, with the period and phase of the step."""
    period = s.values.number("period", 1.0)
    if not period:
        raise Refused("its period is 0")
    phase = s.values.number("phase shift", 0.0)
    clock = s.add(Integrator(s.named("time"), (), SECOND, initial=phase), input=s.constant("one", 1.0))
    return s.function(function, function, s.gain("angle", 2 * math.pi / period, clock.updated))


def _offset(s: SourceStep) -> StepSignal:
    return s.constant("offset", s.values.number("vertical offset", 0.0))
