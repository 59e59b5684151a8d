"""Learned connections, and the chain of serial order."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.adaptive_weights import AdaptiveWeights
from deodar.couplings.axis_weights import AxisWeights
from deodar.couplings.gain import Gain
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.reward_gate import RewardGate
from deodar.couplings.sigmoid import Sigmoid
from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.elements.boost import Boost
from deodar.elements.field import Field
from deodar.importers._piece import Unfit
from deodar.importers.cedar.grid import Counts
from deodar.importers.cedar.piece import InputSlot, OutputSlot, SourceStep, StepPiece
from deodar.importers.cedar.sigmoids import sigmoid
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.box import Box
from deodar.numerics.sigmoids.absolute import Absolute
from deodar.numerics.sigmoids.linear import Linear
from deodar.numerics.sigmoids.step import Step

MOST_WEIGHTS = 4_000_000


def hebbian(b: SourceStep) -> StepPiece:
    """Translate HebbianConnection with Oja's rule.

    With a source of one number: rate g(reward) f(source) (h(target) - w), which is AdaptiveWeights.
    """
    values = b.values
    if values.word("learning rule", "Oja's Rule", ("Oja's Rule", "BCM Rule")) != "Oja's Rule":
        raise Unfit("deodar has no BCM rule")
    source = _size(b, "source", 1)
    target = _size(b, "target", 2)
    if math.prod((*source, *target)) > MOST_WEIGHTS:
        raise Unfit(f"it has more than {MOST_WEIGHTS} weights")
    rate, rule_why = _rate(b)
    f, g = (
        Sigmoid(sigmoid(values, f"{letter} ({what} sigmoid)", Step(0.5)), name=b.named(f"{letter} of {what}"))
        for letter, what in (("f", "source"), ("g", "reward"))
    )
    h = Sigmoid(sigmoid(values, "h (target sigmoid)", Linear(1.0)), name=b.named("h of target"))
    start, start_why = _start(b, source, target)
    axes = b.axes(target)
    inner: list[tuple[str, ...]] = [(f.name, b.label), (h.name, b.label, "post")]
    if not source:
        element: Element = AdaptiveWeights(axes, rate, start=start, gated=True, name=b.label)
        why = "AdaptiveWeights"
    else:
        turned = None if start is None else np.moveaxis(start, range(len(source)), range(-len(source), 0))
        rule = "instar" if not target else "hebb"
        element = Hebbian(
            axes,
            rule,
            rate,
            decay=0.0 if not target else rate,
            threshold=0.0,
            gated=True,
            start=turned,
            name=b.label,
        )
        why = f"Hebbian, rule {rule}"
    elements: list[Element] = [element, f, h]
    reward = _reward(b, g, elements, inner)
    exact = not source or not target
    why = "; ".join(w for w in (why, rule_why, start_why) if w)
    if not exact:
        why += "; cedar forgets at all weights while the gate is open, deodar at those from active samples"
    return StepPiece(
        elements,
        {
            "source node": [[InputSlot(f.name)]],
            "target field": [[InputSlot(h.name)]],
            "reward signal": [[InputSlot(reward)]],
        },
        {"learned output": OutputSlot(b.label, target), "weighted input": OutputSlot(b.label, target)},
        inner,
        wanted={"source node": source, "target field": target, "reward signal": ()},
        needs=("source node", "target field", "reward signal"),
        verdict="approximated",
        why=f"{why}; the output has the weights before the update",
    )


def _size(b: SourceStep, what: str, dimensions: int) -> Counts:
    count = b.values.whole(f"{what} dimension", dimensions, 0, 3)
    return tuple(int(n) for n in b.values.numbers(f"{what} sizes", 50, count, 1, 1e6))


def _rate(b: SourceStep) -> tuple[float, str]:
    """Return the speed of learning per ms, and what differs."""
    rate = b.values.number("learning rate", 0.01, 0.0)
    tau, decay = b.values.number("time scale", 0.0, 0.0), b.values.number("time scale decay", 0.0, 0.0)
    if tau and decay:
        if decay != tau:
            b.values.say("time scale decay", "approximated", f"{tau:g} is used for growth and decay")
        return min(rate / tau, 1 / b.dt), "one time scale" if decay != tau else ""
    if tau:
        return min(rate / tau, 1 / b.dt), ""
    b.values.say("learning rate", "carried", f"divided by the step of {b.dt:g} ms, since cedar's is per step")
    return min(rate / b.dt, 1 / b.dt), ""


def _start(b: SourceStep, source: Counts, target: Counts) -> tuple[np.ndarray | None, str]:
    """Return the weights at the start, source samples first, and what differs."""
    shape = (*source, *target)
    kept = b.stored("weights", shape)
    if kept is not None:
        return kept, ""
    if b.values.flag("manual weights", False):
        count = len(shape)
        centers = b.values.numbers("weight centers", 3.0, count)
        sigmas = b.values.numbers("weight sigmas", 3.0, count, 1e-6)
        out = np.full(shape, b.values.number("weight amplitude", 6.0))
        for d, (n, c, s) in enumerate(zip(shape, centers, sigmas, strict=True)):
            part = np.exp(-0.5 * ((np.arange(n) - c) / s) ** 2)
            out = out * part.reshape([-1 if k == d else 1 for k in range(count)])
        return out, ""
    level, noise = b.values.number("weight init value", 0.0), b.values.number("weight init noise", 0.001)
    if noise != level and noise:
        b.values.say("weight init noise", "approximated", "weights begin at the initial value, without noise")
    return (np.full(shape, level), "") if level else (None, "")


def _reward(b: SourceStep, g: Sigmoid, elements: list[Element], inner: list[tuple[str, ...]]) -> str:
    """Add what opens the gate; return the element that receives the reward."""
    fixed = b.values.flag("fixed reward duration", False)
    duration = b.values.time("reward duration", 200.0)
    elements.append(g)
    if not fixed:
        if "reward duration" in b.values.body:
            b.values.say("reward duration", "carried", "without effect")
        inner.append((g.name, b.label, "gate"))
        return g.name
    window = RewardGate(0.5, max(duration, b.dt), name=b.named("reward window"))
    elements.append(window)
    inner += [(g.name, window.name), (window.name, b.label, "gate")]
    return g.name


def serial_order(b: SourceStep) -> StepPiece:
    """Translate SerialOrder: a field of ordinal nodes and a field of memory nodes over the positions."""
    values = b.values
    count = values.whole("number of ordinal positions", 3, 1, 10)
    axis = Axis("position", 0, count - 1, count) if count > 1 else Axis("position", 0, 1, 1, periodic=True)
    tau = max(values.time("tau", 100.0), b.dt)
    g = sigmoid(values, "sigmoid", Absolute(100.0, 0.0))
    excitation, inhibition = (
        values.number("ordinal self excitation", 11.0),
        values.number("ordinal global inhibition", -11.0),
    )
    own, others = (
        values.number("memory self excitation", 7.0),
        values.number("memory global inhibition", -2.0),
    )
    later, same = values.number("memory to next ordinal", 5.0), values.number("memory to same ordinal", -5.0)
    up, before = values.number("ordinal to same memory", 7.0), values.number("ordinal to prev memory", -7.0)
    cyclic = values.flag("cyclic", False)
    memory, minus = b.named("memory"), b.named("CoS")
    ordinal_field = Field(
        b.label,
        [axis],
        tau=tau,
        resting_level=values.number("ordinal resting level", -5.0),
        sigmoid=g,
        kernel=[Box(excitation - inhibition, 1.0)],
        global_inhibition=-inhibition,
    )
    # cedar's memory nodes are inhibited by all ordinal nodes and excite themselves by what is left
    memory_field = Field(
        memory,
        [axis],
        tau=tau,
        resting_level=values.number("memory resting level", -2.0),
        sigmoid=g,
        kernel=[Box(own - others, 1.0)],
    )
    shift = np.eye(count, k=-1)
    to_next = later * shift
    first = np.zeros(count)
    back = up * np.eye(count) + others * np.ones((count, count))
    if cyclic:
        to_next[0, -1] += later
        back = back + before * np.roll(np.eye(count), 1, axis=1)
    else:
        first[0] = later
        if "ordinal to prev memory" in values.body:
            values.say("ordinal to prev memory", "carried", "without effect, since the chain is not cyclic")
    names = [b.named(w) for w in ("memory to ordinal", "ordinal to memory", "start")]
    elements: list[Element] = [
        ordinal_field,
        memory_field,
        AxisWeights(to_next + same * np.eye(count), axis, name=names[0]),
        AxisWeights(back, axis, name=names[1]),
        Weights(first, [axis], name=names[2]),
        Boost(b.named("one"), (), 1.0),
        Gain(-1.0, name=minus),
        *(Weights(np.eye(count)[k], (), name=b.named(f"node {k}")) for k in range(count)),
    ]
    nodes = [e.name for e in elements[7:]]
    return StepPiece(
        elements,
        {"CoS signal input": [[InputSlot(minus)]]},
        {f"ordinal node {k} output": OutputSlot(name, ()) for k, name in enumerate(nodes)},
        [
            (memory, names[0]),
            (names[0], b.label),
            (b.label, names[1]),
            (names[1], memory),
            (elements[5].name, names[2]),
            (names[2], b.label),
            (minus, b.label),
            *((b.label, name) for name in nodes),
        ],
        wanted={"CoS signal input": ()},
        verdict="approximated",
        why="Field of ordinal nodes and Field of memory nodes; cedar updates nodes one after another",
    )


CLASSES = {
    "cedar.dynamics.HebbianConnection": hebbian,
    "cedar.dynamics.SerialOrder": serial_order,
}
