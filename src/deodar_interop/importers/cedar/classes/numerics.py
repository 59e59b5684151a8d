"""Numerics: integrals, derivatives, smoothing, clocks and oscillators, in seconds.

The state of a bank of oscillators has two rows and a column for each oscillator; that of one oscillator has
two samples.
"""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.delays import Delay
from deodar.elements.variables import Integrator
from deodar.numerics.axes import Axis
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step

SECOND = 1e-3
"""Rate of an integrator that counts seconds, per ms."""

ON = 0.5
"""Value of a reset or run signal above which it is on (a guess)."""

TINY = 1e-30


@step("cedar.processing.steps.Timer", sized=True)
def timer(s: SourceStep) -> None:
    """Translate Timer: seconds for which its run signal is on, since its reset signal was; without any signal
    it is never computed.
    """
    run, reset = (s.optional(f"{name} signal (optional)", ()) for name in ("run", "reset"))
    clock = s.add(Integrator(s.label, (), SECOND if reset is None else 1 / s.dt))
    s.outlet("time", clock, state=True)
    if run is None and reset is None:
        s.explain("Integrator that nothing moves, as in cedar")
        return
    s.explain(f"Integrator; that signals are on above {ON:g} is a guess", "approximated")
    runs = s.constant("one", 1.0) if run is None else s.above("runs", ON, run)
    if reset is None:
        s.connect(runs, clock)
        return
    on = s.above("reset", ON, reset)
    running = s.product("runs without reset", runs, s.rest("no reset", on))
    s.connect(s.gain("time of a step", s.dt * SECOND, running), clock)
    s.connect(s.gain("back to zero", -1.0, s.product("time before reset", clock, on)), clock)


@step("cedar.processing.steps.NumericalIntegration", "input", looped=True)
def integration(s: SourceStep, seen: StepSignal) -> None:
    """Translate NumericalIntegration by Euler steps; it may begin, and begin again, at another input."""
    values, axes, out = s.values, seen.axes, "integration result"
    initial = s.optional("initial state (optional)")
    delay, reset = (s.optional(f"{name} (optional)", ()) for name in ("delay", "reset signal"))
    if values.flag("use BDF5", False):
        values.say("use BDF5", "approximated", "Euler steps are used")
    if not values.flag("initialize on reset", True) and initial is not None:
        values.say("initialize on reset", "approximated", "a reset begins at the initial state here")
    if delay is None and reset is None:
        change = s.add(Integrator(s.label, axes, SECOND), input=seen)
        if initial is None:
            s.outlet(out, change, state=True)
            return
        begins = s.product(
            "initial state at first", _beginning(s, initial, seen), s.rest("first", s.started())
        )
        kept_state = s.add(Delay(axes, name=s.named("initial state kept")))
        s.connect(s.total("initial state to keep", kept_state, begins), kept_state)
        s.outlet(out, s.total("result", change.updated, kept_state.updated))
        s.explain("Integrator, and a Sum with its initial state")
        return
    integral = s.add(Integrator(s.label, axes, 1 / s.dt))
    s.outlet(out, integral, state=True)
    first = None if initial is None else _beginning(s, initial, seen)
    changes = s.gain("change", s.dt * SECOND, seen) if delay is None else s.product("change", seen, delay)
    parts = [changes]
    if first is not None:
        parts.append(s.product("initial state at first", first, s.rest("first", s.started())))
    if reset is not None:
        s.explain(f"Integrator; that the reset signal is on above {ON:g} is a guess", "approximated")
        on = s.above("reset", ON, reset)
        ongoing = s.product("change without reset", s.total("all changes", *parts), s.rest("no reset", on))
        to_zero = s.gain("result back", -1.0, integral)
        goal = to_zero if first is None else s.total("to the initial state", to_zero, first)
        parts = [ongoing, s.product("change by reset", goal, on)]
    for part in parts:
        s.connect(part, integral)


def _beginning(s: SourceStep, initial: StepSignal, seen: StepSignal) -> StepSignal:
    """Return an initial state, which may be one number for all samples."""
    if initial.dims == seen.dims:
        return initial
    if initial.dims:
        raise Unfit(f"its initial state has the size {list(initial.dims)}, and its input {list(seen.dims)}")
    return s.projected("initial state", initial, seen.axes, [])


@step("cedar.processing.steps.NumericalDifferentiation", "input", gives="differentiated result", looped=True)
def differentiation(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate NumericalDifferentiation: the change since the last step by the time that it took.

    Steps that are too short or too long are ignored: the result, and the input that the next change begins
    at, are those before.
    """
    values, took = s.values, s.optional("delay (optional)", ())
    if values.flag("use five points", False):
        values.say("use five points", "approximated", "two points are used")
    shortest = values.number("ignore time steps smaller than", 0.002)
    longest = values.number("ignore time steps larger than", 1.0)
    s.explain("the change by its time; that it is 0 in the first step is a guess", "approximated")
    last = s.add(Delay(seen.axes, name=s.named("last input")))
    change = s.total("change", seen, s.gain("minus last input", -1.0, last))
    if took is None:
        if not shortest <= s.dt * SECOND <= longest:
            return s.gain("", 0.0, change)
        s.connect(seen, last)
        return s.product("", s.gain("speed", 1 / (s.dt * SECOND), change), s.started())
    lasts = s.rest("not short", s.below("short", shortest, took))
    counts = s.product("counts", lasts, s.rest("not long", s.above("long", longest, took)))
    skipped = s.rest("skipped", counts)
    old = s.add(Delay(seen.axes, name=s.named("result before")))
    begun = s.add(Delay((), name=s.named("begun")))
    s.connect(s.limit("begins", "upper", begun, counts), begun)
    s.connect(s.product("new input", seen, counts), last)
    s.connect(s.product("kept input", last, skipped), last)
    speed = s.quotient("speed", change, took, TINY)
    after = s.product("after the first", s.product("new speed", speed, counts), begun)
    derivative = s.total("", after, s.product("kept speed", old, skipped))
    s.connect(derivative, old)
    return derivative


@step("cedar.processing.steps.ExponentialSmoothing", "input", gives="forecast", looped=True)
def smoothing(s: SourceStep, seen: StepSignal) -> StepSignal:
    """Translate ExponentialSmoothing: a level and a trend, l' = a x + (1 - a) (l + m), m' = c (l' - l) + (1 -
    c) m; the first level is the first input.
    """
    a = s.values.number("data smoothing factor", 0.1, 0.0, 1.0)
    share = s.values.number("trend smoothing factor", 0.1, 0.0, 1.0)
    s.explain("a level and a trend; that they begin at the first input and at 0 is a guess", "approximated")
    started = s.started()
    level, trend = (s.add(Delay(seen.axes, name=s.named(f"{role} before"))) for role in ("level", "trend"))
    begin = s.product("first level", seen, s.rest("first step", started))
    old = s.gain("of the level before", 1 - a, s.total("expected", level, trend))
    later = s.product("later level", s.total("mixed level", old, s.gain("of the input", a, seen)), started)
    new = s.total("level", begin, later)
    rise = s.gain("of the rise", share, s.total("rise", new, s.gain("minus level", -1.0, level)))
    slope = s.product(
        "trend", s.total("mixed trend", rise, s.gain("of the trend", 1 - share, trend)), started
    )
    s.connect(new, level)
    s.connect(slope, trend)
    return s.total("", new, slope)


@step("cedar.dynamics.HarmonicOscillator", why="two Integrator", sized=True, looped=True)
def oscillator(s: SourceStep) -> None:
    """Translate HarmonicOscillator: p'' = -K (p - lambda) - 2 D sqrt(K) p', in seconds, speed first."""
    for slot in ("overwriteInput", "overwritePeakDetector"):
        if slot in s.ins:
            raise Unfit(f"what {slot!r} does to its speed is not documented")
    count = s.values.whole("dimensionality", 2, 1, 7)
    if s.values.flag("cyclic restrictions", False):
        raise Unfit("it has cyclic restrictions")
    dims = () if count == 1 else (count,)
    start = np.array(s.values.numbers("Initial Position", 4.0, count))
    stiffness, damping = s.values.number("K", 4.0, 0.0), s.values.number("D", 1.0, 0.0)
    if "B" in s.values.body:
        s.values.say("B", "carried", "without effect, as in cedar")
    place = s.add(
        Integrator(s.label, s.axes(dims), SECOND, start=start)
        if dims
        else Integrator(s.label, (), SECOND, initial=float(start[0]))
    )
    speed = s.add(Integrator(s.named("speed"), s.axes(dims), SECOND))
    pull = s.gain("pull", stiffness, s.slot("lambda", dims))
    drag = s.gain("drag", -2 * damping * math.sqrt(stiffness), speed)
    force = s.total("force", pull, s.gain("away", -stiffness, place), drag)
    s.connect(speed.updated, place)
    s.connect(force, speed)
    # what cedar gives is 0 until its first step
    s.outlet("p", s.total("p", place.updated))
    s.outlet("pDot", s.total("pDot", speed.updated))
    s.outlet("pDotDot", force)


MOST = 1000
"""Largest number of oscillators of a bank (a guess)."""

ROW = Axis("row", 0, 1, 1, periodic=True)


class _Bank:
    """A step with the rows of its state, and its parameters as numbers or inputs."""

    def __init__(self, s: SourceStep) -> None:
        self.s = s
        self.count = s.values.whole("bank size", 1, 1, MOST)
        self.is_single = self.count == 1
        self.columns = s.axes(() if self.is_single else (self.count,))
        if "initial state (optional)" in s.ins:
            raise Unfit("what its initial state changes is not documented; connect it to the integration")
        if "initialize on reset" in s.values.body:
            s.values.say("initialize on reset", "carried", "without effect without an initial state")
        self.state = s.slot("state", (2,) if self.is_single else (2, self.count))

    def row(self, k: int, role: str) -> StepSignal:
        """Return a row of the state, a sample for each oscillator."""
        s, chosen = self.s, np.eye(2)[k : k + 1]
        if self.is_single:
            return s.weighted(role, chosen[0], (), self.state)
        alone = s.turned(f"row of {role}", chosen, ROW, self.state, 0)
        return s.projected(role, alone, self.columns, [None, *self.columns])

    def optional(self, slot: str) -> StepSignal | None:
        """Return what arrives at a slot, one number or one for each oscillator; None without it."""
        slot = f"{slot} (optional)"
        signal = self.s.optional(slot)
        if signal is not None and signal.dims not in ((), tuple(axis.samples for axis in self.columns)):
            raise Unfit(f"{slot!r} has the size {list(signal.dims)} for {self.count} oscillators")
        return signal

    def factor(self, name: str, slot: str) -> float | StepSignal:
        """Return a parameter: a number, or what arrives at its slot."""
        number, signal = self.s.values.number(f"bank {name}", 1.0), self.optional(f"{slot} (bank)")
        return number if signal is None else signal

    def times(self, role: str, factor: float | StepSignal, signal: StepSignal, by: float = 1.0) -> StepSignal:
        """Return a multiple of a row."""
        if not isinstance(factor, StepSignal):
            return self.s.gain(role, by * factor, signal)
        product = self.s.product(role, signal, factor)
        return product if by == 1 else self.s.gain(f"{role} by {by:g}", by, product)

    def change(self, *rows: StepSignal) -> StepSignal:
        """Return the state with the change of each row."""
        s, axes, parts = self.s, self.state.axes, list[StepSignal]()
        for k, (signal, row) in enumerate(zip(rows, ("first", "second"), strict=True)):
            if self.is_single:
                parts.append(s.weighted(f"{row} row", np.eye(2)[k], axes, signal))
            else:
                wide = s.projected(f"{row} as a row", signal, (ROW, axes[1]), [axes[1]])
                parts.append(s.turned(f"{row} row", np.eye(2)[:, k : k + 1], axes[0], wide, 0))
        return s.total("", *parts)


ROWS = "Product and Sum of the rows"


@step("cedar.processing.steps.HopfOscillatorRHS", gives="state change", why=ROWS, sized=True)
def hopf(s: SourceStep) -> StepSignal:
    """Translate HopfOscillatorRHS: u' = alpha u - omega v - gamma r^2 u, v' = alpha v + omega u - gamma r^2
    v.
    """
    if s.values.number("shift u by radius fraction", 0.0):
        raise Unfit("the shift of u by a fraction of the radius is not documented")
    bank = _Bank(s)
    u, v = bank.row(0, "u"), bank.row(1, "v")
    alpha, omega, gamma = (bank.factor(name, f"{name}s") for name in ("alpha", "omega", "gamma"))
    squares = s.function("u squared", "square", u), s.function("v squared", "square", v)
    pull = bank.times("pull", gamma, s.total("radius squared", *squares), -1.0)
    grown, turned = bank.times("alpha u", alpha, u), bank.times("omega v", omega, v, -1.0)
    first = s.total("change of u", grown, turned, s.product("pull of u", u, pull))
    grown, turned = bank.times("alpha v", alpha, v), bank.times("omega u", omega, u)
    return bank.change(first, s.total("change of v", grown, turned, s.product("pull of v", v, pull)))


@step("cedar.processing.steps.HarmonicOscillatorRHS", gives="state change", sized=True)
def harmonic(s: SourceStep) -> StepSignal:
    """Translate HarmonicOscillatorRHS: x' = v, v' = -stiffness (x - shift) - damping v."""
    bank = _Bank(s)
    x, v = bank.row(0, "x"), bank.row(1, "v")
    stiffness, shift = bank.factor("stiffness", "stiffnesss"), bank.optional("shift")
    distance = x if shift is None else s.total("distance", x, s.gain("minus shift", -1.0, shift))
    if not s.values.flag("force critically damped", False):
        damping = bank.factor("damping", "damping")
    elif not isinstance(stiffness, StepSignal):
        damping = 2 * max(stiffness, 0.0) ** 0.5
    else:
        damping = s.gain("critical damping", 2.0, s.function("root of stiffness", "root", stiffness))
    doubt = "cedar's equation is not documented, that of a damped spring and a mass of 1 is used"
    s.explain(f"{ROWS}; {doubt}", "approximated")
    pull, drag = bank.times("pull", stiffness, distance, -1.0), bank.times("drag", damping, v, -1.0)
    return bank.change(v, s.total("force", pull, drag))
