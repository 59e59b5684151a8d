"""Fields, nodes and traces."""

from __future__ import annotations

import math

import numpy as np

from deodar.elements.field import Field
from deodar.elements.memories import History, MemoryTrace, SampledHistory
from deodar.elements.populations import RateNode
from deodar.elements.stimuli import Boost
from deodar.elements.variables import Integrator
from deodar.model.paths import display
from deodar.numerics.axes import Axis, shape
from deodar.numerics.sigmoids import Logistic
from deodar.numerics.windows import FOR_EVER
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, Unfit, axes
from deodar_interop.importers.cosivina.constructors import PHASE_PLOT
from deodar_interop.importers.cosivina.element import SourceElement

STEEPEST = 1e6

MOST_COUNTED = 1_000_000
"""Number of steps up to which cosivina's counting of time is reproduced, with its rounding."""


@translates("NeuralField")
def neural_field(b: SourceElement) -> None:
    """Translate NeuralField: kernels and noise remain separate elements, as in the file."""
    dims = b.sized()
    sigmoid = Logistic(b.values.number("beta", 4, 1e-6, STEEPEST))
    tau, level = _tau(b, "tau", 10), b.values.number("h", -5)
    field = b.add(
        Field(b.label, axes(dims), tau=tau, resting_level=level, sigmoid=sigmoid), input=_added(b, dims)
    )
    for component in ("output", "activation"):
        b.outlet(component, field.at(component), state=True)
    if "h" in b.components_read:  # plots of cosivina add it to what they show
        b.outlet("h", b.add(Boost(b.named("h"), (), level), (None, None)), still=True)
    b.piece.elsewhere = {"h": _level(b)}


@translates("SingleNodeDynamics")
def single_node(b: SourceElement) -> None:
    """Translate SingleNodeDynamics, without the samples of its phase plot."""
    for name in ("range", "resolution"):
        if name in b.element.values:
            b.values.say(name, "carried", "of the phase plot only: dd.phase takes its own")
    node = RateNode(
        b.label,
        tau=_tau(b, "tau", 10),
        resting_level=b.values.number("h", -5),
        sigmoid=Logistic(b.values.number("beta", 4, 1e-6, STEEPEST)),
        self_excitation=b.values.number("selfExcitation", 0),
        noise=b.values.number("noiseLevel", 0, 0),
    )
    output = b.add(node, input=_added(b, (None, None)))
    for component, port in {"output": "output", "activation": "activation", "rateOfChange": "rate"}.items():
        b.outlet(component, output.at(port), state=True)
    b.piece.elsewhere = {"h": _level(b), "input": f"read {display((b.label, 'input'))}"}
    b.piece.elsewhere |= dict.fromkeys(PHASE_PLOT, "of the phase plot only: dd.phase computes it")


def _added(b: SourceElement, dims: Dims) -> ElementSignal:
    """Return the sum of all inputs, of which there may be none."""
    return b.input(dims, whole=False, needed=False, sums=True)


def _level(b: SourceElement) -> str:
    return f"the parameter {display((b.label, 'resting_level'))}"


@translates("MemoryTrace")
def memory_trace(b: SourceElement) -> None:
    """Translate MemoryTrace.

    Its rates are per step for any step, so that time constants are those of the file times its step.
    """
    dims = b.sized()
    build = _per_step(b, "tauBuild", 100)
    decay = _per_step(b, "tauDecay", b.values.number("tauBuild", 100, 1e-6))
    threshold = b.values.number("threshold", 0.5)
    trace = b.add(
        MemoryTrace(b.label, axes(dims), tau_build=build, tau_decay=decay, threshold=threshold),
        input=b.input(dims, whole=False),
    )
    b.outlet("output", trace, state=True)
    b.outlet("activeRegions", trace.at("active"), state=True)


@translates("DynamicVariable")
def dynamic_variable(b: SourceElement) -> None:
    """Translate DynamicVariable, an integrator."""
    dims = b.sized()
    tau = b.values.number("tau", 10)
    if tau == 0:
        tau = 10.0
        b.values.say("tau", "approximated", "it is 0; cosivina's default 10 is used")
    elif "tau" in b.element.values and b.values.lines["tau"].verdict == "carried":
        b.values.say("tau", "carried", "as the rate 1 / tau")
    initial_state = b.values.matrix("initialState")
    if initial_state is not None and initial_state.size not in (1, math.prod(shape(axes(dims)))):
        raise Unfit("its initialState is not of its size")
    level = initial_state is not None and len({float(v) for v in initial_state.reshape(-1)}) == 1
    initial = float(initial_state.reshape(-1)[0]) if initial_state is not None and level else 0.0
    start = initial_state.reshape(shape(axes(dims))) if initial_state is not None and not level else None
    element = Integrator(b.label, axes(dims), 1 / tau, initial, start)
    b.outlet("state", b.add(element, input=_added(b, dims)), state=True)
    held = display((b.label, "initial" if start is None else "start"))
    b.piece.elsewhere = {"initialState": f"the parameter {held}"}


@translates("RunningHistory")
def running_history(b: SourceElement) -> None:
    """Translate RunningHistory: the newest row first."""
    dims = b.of(b.values.size())
    slots, out_dims = _slots(b, dims, int(b.values.number("timeSlots", 1, 1, 100_000)))
    element = History(b.label, axes(dims), slots, b.values.number("interval", 1, 1e-6), _empty(b))
    _store(b, element, dims, out_dims)


@translates("History")
def history(b: SourceElement) -> None:
    """Translate History: a row for each listed time."""
    dims = b.of(b.values.size())
    storing_times = b.values.matrix("storingTimes")
    if storing_times is None:
        raise Unfit("it lists no times at which to store")
    times = storing_times.reshape(-1)
    slots, out_dims = _slots(b, dims, times.size)
    element = SampledHistory(b.label, axes(dims), slots, _moments(b, times), _empty(b))
    _store(b, element, dims, out_dims)


def _moments(b: SourceElement, times: np.ndarray) -> np.ndarray:
    """Return the times at which cosivina stores: those that a step reaches.

    The others are replaced by a time that no run reaches.
    """
    start, step = b.simulator.start, b.step
    ticks = np.round((times - start) / step)
    reached = (ticks >= 1) & (abs((times - start) / step - ticks) <= 1e-6)
    if reached.any() and ticks[reached].max() <= MOST_COUNTED:
        # as cosivina counts, with the same rounding
        counted = np.add.accumulate([start, *[step] * int(ticks[reached].max())])
        exact = np.isin(times, counted)
        missed = int((reached & ~exact).sum())
        if missed and b.bug(
            f"History compares times exactly, and misses {missed} of {times.size} by rounding"
        ):
            reached = reached & exact
    lost = times.size - int(reached.sum())
    if lost:
        b.values.say(
            "storingTimes",
            "carried",
            f"no step ends at {lost} of {times.size} of them; their rows stay empty, as in cosivina",
        )
    return np.where(reached, start + ticks * step, FOR_EVER)


def _slots(b: SourceElement, dims: Dims, count: int) -> tuple[Axis, Dims]:
    """The axis of what is stored, and the dimensions of the whole as cosivina has them."""
    stated = b.dims()
    slots = Axis("slot", 0, max(count - 1, 1), count, periodic=count == 1)
    if b.components_read:  # an element that reads it takes the times for rows
        slots = stated[0 if dims[0] is None else -1] or slots
    return slots, stated if count == 1 else (slots, dims[1]) if dims[0] is None else (*dims, slots)


def _empty(b: SourceElement) -> str:
    """Return what cosivina shows for a slot without a stored value.

    Where elements read it, this value would make them undefined permanently.
    """
    return "zero" if b.components_read else "nan"


def _store(b: SourceElement, element: History | SampledHistory, dims: Dims, out_dims: Dims) -> None:
    b.outlet("output", b.add(element, out_dims, input=b.input(dims, whole=False)), state=True)
    if b.components_read:
        doubt = (
            "what is not stored yet is 0, since elements read it: NaN, as in cosivina, would make them"
            " undefined permanently"
        )
        b.explain(f"{type(element).__name__}; {doubt}", "approximated")


def _tau(b: SourceElement, name: str, default: float) -> float:
    """Return a time constant; one below the step diverges or is refused."""
    return b.values.number(name, default, b.step)


def _per_step(b: SourceElement, name: str, default: float) -> float:
    rate = b.values.number(name, default, 1e-6)
    if name in b.element.values and b.step != 1 and b.values.lines[name].verdict == "carried":
        b.values.say(name, "carried", f"times the step {b.step:g}, since cosivina's rate is per step")
    return max(rate * b.step, 1e-6)
