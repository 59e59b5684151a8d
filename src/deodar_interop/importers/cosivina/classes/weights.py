"""Weights, fixed and learning."""

from __future__ import annotations

from typing import TypeVar

from deodar.couplings.adaptive_weights import AdaptiveWeights
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.reward_gate import RewardGate
from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar_interop.importers._piece import Inlet, Outlet, Piece, Unfit, axes
from deodar_interop.importers._values import LARGEST
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import empty


def weight_matrix(b: SourceElement) -> Piece:
    """Translate WeightMatrix: a row times a matrix."""
    rows, columns = b.values.size()[:2]
    weights = b.values.matrix("weights")
    if weights is not None and "size" not in b.element.values and weights.ndim == 2:
        rows, columns = weights.shape
    came, dims = b.of((1, rows)), b.of((1, columns))
    if weights is None or weights.size != rows * columns:
        raise Unfit(f"its weights are not of the size {[rows, columns]}")
    ours = weights.reshape(rows, columns).T.reshape(shape(axes(dims)) + shape(axes(came)))
    element = Weights(ours, axes(dims), name=b.label)
    return Piece(
        [element],
        [[Inlet(b.label, came, whole=True)]],
        {"output": Outlet(b.label, dims)},
        needs=1,
        why="Weights",
    )


def adaptive_weight_matrix(b: SourceElement) -> Piece:
    """Translate AdaptiveWeightMatrix.

    Its rate is per step, and its weights are not in the file; they begin at 0, as in cosivina.
    """
    rows, columns = b.values.size()[:2]
    came, dims = b.of((1, rows)), b.of((1, columns))
    gated = len(b.element.sources) > 2
    rate = b.values.number("learningRate", 0.1, 0) / b.step
    if b.step != 1 and "learningRate" in b.element.values:
        b.values.say(
            "learningRate", "carried", f"divided by the step {b.step:g}, since cosivina's rate is per step"
        )
    components = [s.component for s in b.element.sources[:2]]
    apart = len(set(components)) > 1 and b.bug(
        f"AdaptiveWeightMatrix learns from {components[1]!r} of its first input instead of {components[0]!r}"
    )
    element = AdaptiveWeights(axes(dims), rate, 0.0, gated, apart, name=b.label)
    pre = [Inlet(b.label, came, "pre", whole=True, component=components[1])] if apart else []
    inlets = [
        [Inlet(b.label, came, whole=True), *pre],
        [Inlet(b.label, dims, "post")],
        *([[Inlet(b.label, (None, None), "gate")]] if gated else []),
    ]
    why = "AdaptiveWeights, from weights of 0"
    elsewhere = {"weights": f"read {display((b.label, 'weights'))}"}
    return Piece([element], inlets, {"output": Outlet(b.label, dims)}, elsewhere=elsewhere, needs=1, why=why)


REWARDED = 0.9
"""Threshold of a reward in cosivina."""


def hebbian(b: SourceElement) -> Piece:
    """Translate HebbianConnection.

    A file has at most two of its parameters; the others are cosivina's defaults, and the report lists each.

    cosivina calls `instar` the rule that moves weights from active sources towards the target; 0 selects the
    other rule.
    """
    came, dims = b.source(0), b.source(1)
    if came is None or dims is None:
        raise Unfit("it learns between two inputs, and one is missing")
    if "size" in b.element.values:
        b.values.say("size", "carried", "it follows from the inputs")
    rate, tau, decay = (
        _default(b, name, default)
        for name, default in (("learningRate", 0.1), ("tau", 1.0), ("tauDecay", 1.0))
    )
    if tau != decay:
        b.values.say(
            "tauDecay",
            "approximated",
            f"it is {decay:g}; weights to silent places change with tau = {tau:g} as well",
        )
    rule = "outstar" if _default(b, "instar", 0.0) else "instar"
    if str(b.element.values.get("biDirectional", "FALSE")) == "TRUE":
        b.values.say("biDirectional", "dropped", "reverse_output is not given")
    else:
        _default(b, "biDirectional", "FALSE")
    manual = next(
        (name for name in ("manualWeights", "weightsParameters") if not empty(b.element.values.get(name))), ""
    )
    if manual:
        b.values.say(manual, "dropped", "weights begin at 0")
    else:
        b.values.say(
            "manualWeights", "approximated", "it is not in the file; weights begin at 0, cosivina's default"
        )
    gated = len(b.element.sources) > 2
    duration = _duration(b, gated)
    element = Hebbian(axes(dims), rule, max(rate / tau, 0.0), threshold=0.0, gated=gated, name=b.label)
    inlets, elements, inner = (
        [[Inlet(b.label, came, whole=True)], [Inlet(b.label, dims, "post")]],
        list[Element]([element]),
        list[tuple[str, ...]](),
    )
    if gated:
        gate = RewardGate(REWARDED, duration, name=b.named("reward"))
        elements.append(gate)
        inner.append((gate.name, b.label, "gate"))
        inlets.append([Inlet(gate.name, (None, None), whole=True)])
    elsewhere = {"weights": f"read {display((b.label, 'weights'))}"}
    why = "Hebbian, with defaults for what is not in the file; input that is not above 0 counts as 0"
    return Piece(
        elements,
        inlets,
        {"output": Outlet(b.label, dims)},
        inner,
        elsewhere=elsewhere,
        needs=2,
        verdict="approximated",
        why=why,
    )


T = TypeVar("T", float, str)


def _default(b: SourceElement, name: str, default: T) -> T:
    """Return a parameter of the file, or cosivina's default, which the report then lists."""
    if name not in b.element.values:
        b.values.say(name, "approximated", f"it is not in the file; cosivina's default {default} is used")
        return default
    if isinstance(default, str):
        b.values.say(name)
        return default
    lower = 1e-6 if name.startswith("tau") else -LARGEST
    return b.values.number(name, default, lower)


def _duration(b: SourceElement, gated: bool) -> float:
    """Return how long a reward enables learning; 0: while it lasts."""
    if "rewardDuration" not in b.element.values:
        b.values.say(
            "rewardDuration",
            "approximated",
            "it is not in the file; cosivina's default [-1, -1] is used, no fixed duration",
        )
        return 0.0
    delay, duration = b.values.numbers("rewardDuration", [-1.0, -1.0], 2)
    if not gated or delay == -1 or duration == -1:
        return 0.0
    if delay:
        b.values.say(
            "rewardDuration",
            "approximated",
            f"learning begins with the reward, without the delay of {delay:g}",
        )
    return max(duration, 0.0)


CLASSES = {
    "WeightMatrix": weight_matrix,
    "AdaptiveWeightMatrix": adaptive_weight_matrix,
    "HebbianConnection": hebbian,
}
