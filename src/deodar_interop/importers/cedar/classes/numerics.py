"""Numerics: integrals, derivatives, smoothing, clocks and oscillators, in seconds."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.delay import Delay
from deodar.couplings.sigmoid import Sigmoid
from deodar.elements.integrator import Integrator
from deodar.numerics.sigmoids.step import Step
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import InputSlot, OutputSlot, SourceStep, StepPiece

SECOND = 1e-3
"""Rate of an integrator that counts seconds, per ms."""

ON = 0.5
"""Value of a reset or run signal above which it is on (a guess)."""

TINY = 1e-30


def timer(b: SourceStep) -> StepPiece:
    """Translate Timer: seconds for which its run signal is on, since its reset signal was; without any signal
    it is never computed.
    """
    run, reset = "run signal (optional)", "reset signal (optional)"
    if run not in b.ins and reset not in b.ins:
        clock = Integrator(b.label, (), SECOND)
        outlets = {"time": OutputSlot(b.label, (), state=True)}
        return StepPiece([clock], outlets=outlets, why="Integrator that nothing moves, as in cedar")
    why = f"Integrator; that signals are on above {ON:g} is a guess"
    if reset not in b.ins:
        clock, runs = Integrator(b.label, (), SECOND), Sigmoid(Step(ON), name=b.named("runs"))
        return StepPiece(
            [clock, runs],
            {run: [[InputSlot(runs.name)]]},
            {"time": OutputSlot(b.label, (), state=True)},
            [(runs.name, b.label)],
            wanted={run: ()},
            verdict="approximated",
            why=why,
        )
    c = Composition(b)
    on = c.above("reset", ON, c.slot(reset, (), optional=True))
    runs = c.above("runs", ON, c.slot(run, (), optional=True)) if run in b.ins else c.constant("one", 1.0)
    passed = c.gain(
        "time of a step", b.dt * SECOND, c.product("runs without reset", runs, c.rest("no reset", on))
    )
    gone = c.gain("back to zero", -1.0, c.product("time before reset", StepSignal(b.label), on))
    c.add(Integrator(b.label, (), 1 / b.dt), input=(passed, gone))
    c.outlet("time", StepSignal(b.label), (), state=True)
    return c.done(why, "approximated")


def integration(b: SourceStep) -> StepPiece:
    """Translate NumericalIntegration by Euler steps; it may begin, and begin again, at another input."""
    dims, values = b.first("input"), b.values
    axes = b.axes(dims)
    start, delay, reset = (f"{name} (optional)" for name in ("initial state", "delay", "reset signal"))
    verdict, why = "carried", "Integrator"
    if values.flag("use BDF5", False):
        values.say("use BDF5", "approximated", "Euler steps are used")
    if not values.flag("initialize on reset", True) and start in b.ins:
        values.say("initialize on reset", "approximated", "a reset begins at the initial state here")
    c = Composition(b)
    seen = c.slot("input")
    if not {start, delay, reset} & set(b.ins):
        c.add(Integrator(b.label, axes, SECOND), input=seen)
        c.outlet("integration result", StepSignal(b.label), dims, state=True)
        return c.done(why)
    first = None if start not in b.ins else _beginning(c, start, dims)
    begins = (
        None if first is None else c.product("initial state at first", first, c.rest("first", c.started()))
    )
    if begins is not None and not {delay, reset} & set(b.ins):
        kept_state = c.add(Delay(axes, name=b.named("initial state kept")))
        c.connect(c.total("initial state to keep", kept_state, begins), kept_state.name)
        c.add(Integrator(b.label, axes, SECOND), input=seen)
        ends = (StepSignal(name, reads="current") for name in (b.label, kept_state.name))
        c.outlet("integration result", c.total("result", *ends), dims)
        return c.done("Integrator, and a Sum with its initial state")
    if delay in b.ins:
        parts = [c.product("change", seen, c.slot(delay, (), optional=True))]
    else:
        parts = [c.gain("change", b.dt * SECOND, seen)]
    parts += [] if begins is None else [begins]
    if reset in b.ins:
        verdict, why = "approximated", f"Integrator; that the reset signal is on above {ON:g} is a guess"
        on = c.above("reset", ON, c.slot(reset, (), optional=True))
        ongoing = c.product("change without reset", c.total("all changes", *parts), c.rest("no reset", on))
        to_zero = c.gain("result back", -1.0, StepSignal(b.label))
        goal = to_zero if first is None else c.total("to the initial state", to_zero, first)
        parts = [ongoing, c.product("change by reset", goal, on)]
    c.add(Integrator(b.label, axes, 1 / b.dt), input=parts)
    c.outlet("integration result", StepSignal(b.label), dims, state=True)
    return c.done(why, verdict)


def _beginning(c: Composition, slot: str, dims: Counts) -> StepSignal:
    """Return an initial state, which may be one number for all samples."""
    dims_of_state, signal = c.b.first(slot), c.slot(slot, optional=True)
    if dims_of_state and dims_of_state != dims:
        raise Unfit(f"its initial state has the size {list(dims_of_state)}, and its input {list(dims)}")
    return signal if dims_of_state == dims else c.projected("initial state", signal, (), c.b.axes(dims), [])


def differentiation(b: SourceStep) -> StepPiece:
    """Translate NumericalDifferentiation: the change since the last step by the time that it took.

    Steps that are too short or too long are ignored: the result, and the input that the next change begins
    at, are those before.
    """
    dims, values = b.first("input"), b.values
    axes, slot = b.axes(dims), "delay (optional)"
    if values.flag("use five points", False):
        values.say("use five points", "approximated", "two points are used")
    shortest = values.number("ignore time steps smaller than", 0.002)
    longest = values.number("ignore time steps larger than", 1.0)
    c = Composition(b)
    seen = c.slot("input")
    out, last = StepSignal(b.label), c.add(Delay(axes, name=b.named("last input")))
    change = c.total("change", seen, c.gain("minus last input", -1.0, last))
    if slot not in b.ins:
        if not shortest <= b.dt * SECOND <= longest:
            c.gain("", 0.0, change)
        else:
            c.connect(seen, last.name)
            speed = c.gain("speed", 1 / (b.dt * SECOND), change)
            c.product("", speed, c.started())
    else:
        took = c.slot(slot, (), optional=True)
        lasts = c.rest("not short", c.below("short", shortest, took))
        counts = c.product("counts", lasts, c.rest("not long", c.above("long", longest, took)))
        skipped = c.rest("skipped", counts)
        old = c.before("result before", out, axes)
        begun = c.add(Delay((), name=b.named("begun")))
        c.connect(c.limit("begins", "upper", begun, counts), begun.name)
        c.connect(c.product("new input", seen, counts), last.name)
        c.connect(c.product("kept input", last, skipped), last.name)
        speed = c.quotient("speed", change, took, TINY)
        after = c.product("after the first", c.product("new speed", speed, counts), begun)
        c.total("", after, c.product("kept speed", old, skipped))
    c.outlet("differentiated result", out, dims)
    return c.done("the change by its time; that it is 0 in the first step is a guess", "approximated")


def smoothing(b: SourceStep) -> StepPiece:
    """Translate ExponentialSmoothing: a level and a trend, l' = a x + (1 - a) (l + m), m' = c (l' - l) + (1 -
    c) m; the first level is the first input.
    """
    dims, axes = b.first("input"), b.axes(b.first("input"))
    a = b.values.number("data smoothing factor", 0.1, 0.0, 1.0)
    share = b.values.number("trend smoothing factor", 0.1, 0.0, 1.0)
    c = Composition(b)
    seen, started = c.slot("input"), c.started()
    level, trend = (c.add(Delay(axes, name=b.named(f"{role} before"))) for role in ("level", "trend"))
    begin = c.product("first level", seen, c.rest("first step", started))
    old = c.gain("of the level before", 1 - a, c.total("expected", level, trend))
    later = c.product("later level", c.total("mixed level", old, c.gain("of the input", a, seen)), started)
    new = c.total("level", begin, later)
    rise = c.total("rise", new, c.gain("minus level", -1.0, level))
    mixed = c.total(
        "mixed trend", c.gain("of the rise", share, rise), c.gain("of the trend", 1 - share, trend)
    )
    slope = c.product("trend", mixed, started)
    c.connect(new, level.name)
    c.connect(slope, trend.name)
    c.outlet("forecast", c.total("", new, slope), dims)
    why = "a level and a trend; that they begin at the first input and at 0 is a guess"
    return c.done(why, "approximated")


def oscillator(b: SourceStep) -> StepPiece:
    """Translate HarmonicOscillator: p'' = -K (p - lambda) - 2 D sqrt(K) p', in seconds, speed first."""
    for slot in ("overwriteInput", "overwritePeakDetector"):
        if slot in b.ins:
            raise Unfit(f"what {slot!r} does to its speed is not documented")
    count = b.values.whole("dimensionality", 2, 1, 7)
    if b.values.flag("cyclic restrictions", False):
        raise Unfit("it has cyclic restrictions")
    dims = () if count == 1 else (count,)
    axes = b.axes(dims)
    start = np.array(b.values.numbers("Initial Position", 4.0, count))
    stiffness, damping = b.values.number("K", 4.0, 0.0), b.values.number("D", 1.0, 0.0)
    if "B" in b.values.body:
        b.values.say("B", "carried", "without effect, as in cedar")
    c = Composition(b)
    if dims:
        place = Integrator(b.label, axes, SECOND, start=start)
    else:
        place = Integrator(b.label, axes, SECOND, initial=float(start[0]))
    speed = Integrator(b.named("speed"), axes, SECOND)
    pull = c.gain("pull", stiffness, c.slot("lambda", dims))
    spring = c.gain("away", -stiffness, StepSignal(place.name))
    drag = c.gain("drag", -2 * damping * math.sqrt(stiffness), StepSignal(speed.name))
    force = c.total("force", pull, spring, drag)
    c.add(place, input=StepSignal(speed.name, reads="current"))
    c.add(speed, input=force)
    # what cedar gives is 0 until its first step
    for slot, name in (("p", place.name), ("pDot", speed.name)):
        c.outlet(slot, c.total(slot, StepSignal(name, reads="current")), dims)
    c.outlet("pDotDot", force, dims)
    return c.done("two Integrator")


CLASSES = {
    "cedar.processing.steps.Timer": timer,
    "cedar.processing.steps.NumericalIntegration": integration,
    "cedar.processing.steps.NumericalDifferentiation": differentiation,
    "cedar.processing.steps.ExponentialSmoothing": smoothing,
    "cedar.dynamics.HarmonicOscillator": oscillator,
}

DECLARED = frozenset({"cedar.dynamics.HarmonicOscillator", "cedar.processing.steps.Timer"})

LOOPED = frozenset(
    {
        "cedar.dynamics.HarmonicOscillator",
        "cedar.processing.steps.ExponentialSmoothing",
        "cedar.processing.steps.NumericalDifferentiation",
        "cedar.processing.steps.NumericalIntegration",
    }
)
