"""Fields, nodes and traces."""

from __future__ import annotations

from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.field import Field
from deodar.elements.history import History
from deodar.elements.memory_trace import MemoryTrace
from deodar.elements.rate_node import RateNode
from deodar.importers.cosivina.components import PHASE_PLOT
from deodar.importers.cosivina.piece import Bench, Inlet, Outlet, Piece, axes
from deodar.importers.cosivina.sizes import Dims
from deodar.model.paths import display
from deodar.numerics.axes import Axis
from deodar.numerics.sigmoids.logistic import Logistic

STEEPEST = 1e6


def neural_field(b: Bench) -> Piece:
    """NeuralField: kernels and noise stay elements of their own, as in the file."""
    b.values.size()
    dims = b.dims()
    sigmoid = Logistic(b.values.number("beta", 4, 1e-6, STEEPEST))
    field = Field(b.label, axes(dims), tau=_tau(b, "tau", 10), resting_level=b.values.number("h", -5), sigmoid=sigmoid)
    outlets = {c: Outlet(b.label, dims, c, state=True) for c in ("output", "activation")}
    elements: list[Element] = [field]
    if "h" in b.asked:  # plots of cosivina add it to what they show
        level = Boost(b.named("h"), (), field.resting_level)
        elements.append(level)
        outlets["h"] = Outlet(level.name, (None, None), still=True)
    return Piece(elements, [[Inlet(b.label, dims)]], outlets, elsewhere={"h": _level(b)}, sums=True, why="Field")


def single_node(b: Bench) -> Piece:
    """SingleNodeDynamics, without the samples of its phase plot."""
    for name in ("range", "resolution"):
        if name in b.element.values:
            b.values.say(name, "carried", "of the phase plot only: deodar.analysis.phase takes its own")
    node = RateNode(
        b.label,
        tau=_tau(b, "tau", 10),
        resting_level=b.values.number("h", -5),
        sigmoid=Logistic(b.values.number("beta", 4, 1e-6, STEEPEST)),
        self_excitation=b.values.number("selfExcitation", 0),
        noise=b.values.number("noiseLevel", 0, 0),
    )
    ports = {"output": "output", "activation": "activation", "rateOfChange": "rate"}
    elsewhere = {"h": _level(b), "input": f"read {display((b.label, 'input'))}"}
    elsewhere |= dict.fromkeys(PHASE_PLOT, "of the phase plot only: deodar.analysis.phase computes it")
    outlets = {c: Outlet(b.label, (None, None), port, state=True) for c, port in ports.items()}
    return Piece([node], [[Inlet(b.label, (None, None))]], outlets, elsewhere=elsewhere, sums=True, why="RateNode")


def _level(b: Bench) -> str:
    return f"the parameter {display((b.label, 'resting_level'))}"


def memory_trace(b: Bench) -> Piece:
    """MemoryTrace; its rates are per step, whatever the step is, so that time constants are those of the file times its step."""
    b.values.size()
    dims = b.dims()
    build = _per_step(b, "tauBuild", 100)
    decay = _per_step(b, "tauDecay", b.values.number("tauBuild", 100, 1e-6))
    trace = MemoryTrace(b.label, axes(dims), tau_build=build, tau_decay=decay, threshold=b.values.number("threshold", 0.5))
    outlets = {c: Outlet(b.label, dims, port, state=True) for c, port in (("output", "output"), ("activeRegions", "active"))}
    return Piece([trace], [[Inlet(b.label, dims)]], outlets, needs=1, why="MemoryTrace")


def running_history(b: Bench) -> Piece:
    """RunningHistory: the newest row first."""
    own = b.values.size()
    dims = b.of(own)
    count = int(b.values.number("timeSlots", 1, 1, 100_000))
    kept = b.dims()
    slots = Axis("slot", 0, max(count - 1, 1), count, periodic=count == 1)
    if b.asked:  # who reads it takes the moments for rows
        slots = kept[0 if dims[0] is None else -1] or slots
    history = History(b.label, axes(dims), slots, b.values.number("interval", 1, 1e-6))
    shown: Dims = kept if count == 1 else (slots, dims[1]) if dims[0] is None else (*dims, slots)
    why = "History; moments that have not come yet are 0, where cosivina has NaN"
    return Piece([history], [[Inlet(b.label, dims)]], {"output": Outlet(b.label, shown, state=True)}, needs=1, why=why)


def _tau(b: Bench, name: str, default: float) -> float:
    """A time constant; one below the step diverges or is refused."""
    return b.values.number(name, default, b.step)


def _per_step(b: Bench, name: str, default: float) -> float:
    value = b.values.number(name, default, 1e-6)
    if name in b.element.values and b.step != 1 and b.values.lines[name].verdict == "carried":
        b.values.say(name, "carried", f"times the step {b.step:g}, since cosivina's rate is per step")
    return max(value * b.step, 1e-6)


CLASSES = {"NeuralField": neural_field, "SingleNodeDynamics": single_node, "MemoryTrace": memory_trace, "RunningHistory": running_history}
