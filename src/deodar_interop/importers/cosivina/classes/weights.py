"""Weights, fixed and learning."""

from __future__ import annotations

import dataclasses as dc
from typing import TypeVar

from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights, RewardGate
from deodar.couplings.weights import Weights
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Unfit, axes
from deodar_interop.importers._values import LARGEST
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import empty


@translates("WeightMatrix")
def weight_matrix(b: SourceElement) -> ElementSignal:
    """Translate WeightMatrix: a row times a matrix."""
    rows, columns = b.values.size()[:2]
    weights = b.values.matrix("weights")
    if weights is not None and "size" not in b.element.values and weights.ndim == 2:
        rows, columns = weights.shape
    came, dims = b.of((1, rows)), b.of((1, columns))
    if weights is None or weights.size != rows * columns:
        raise Unfit(f"its weights are not of the size {[rows, columns]}")
    ours = weights.reshape(rows, columns).T.reshape(shape(axes(dims)) + shape(axes(came)))
    return b.add(Weights(ours, axes(dims), name=b.label), dims, input=b.input(came))


@translates("AdaptiveWeightMatrix")
def adaptive_weight_matrix(b: SourceElement) -> ElementSignal:
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
    seen = b.input(came)
    weights = b.add(element, dims, input=seen)
    if apart:
        b.connect(dc.replace(seen, component=components[1]), weights, "pre")
    b.connect(b.input(dims, whole=False, needed=False), weights, "post")
    if gated:
        b.connect(b.input((None, None), whole=False, needed=False), weights, "gate")
    b.piece.elsewhere = {"weights": f"read {display((b.label, 'weights'))}"}
    b.explain("AdaptiveWeights, from weights of 0")
    return weights


REWARDED = 0.9
"""Threshold of a reward in cosivina."""


@translates("HebbianConnection")
def hebbian(b: SourceElement) -> ElementSignal:
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
    weights = b.add(element, dims, input=b.input(came), post=b.input(dims, whole=False))
    if gated:
        gate = RewardGate(REWARDED, duration, name=b.named("reward"))
        gate_output = b.add(gate, input=b.input((None, None), needed=False))
        b.connect(gate_output, weights, "gate")
    b.piece.elsewhere = {"weights": f"read {display((b.label, 'weights'))}"}
    why = "Hebbian, with defaults for what is not in the file; input that is not above 0 counts as 0"
    b.explain(why, "approximated")
    return weights


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
