"""Weights, fixed and learning."""

from __future__ import annotations

from deodar.couplings.adaptive_weights import AdaptiveWeights
from deodar.couplings.weights import Weights
from deodar.importers.cosivina.piece import Bench, Inlet, Outlet, Piece, Unfit, axes
from deodar.model.paths import display
from deodar.numerics.axes import shape


def weight_matrix(b: Bench) -> Piece:
    """WeightMatrix: a row times a matrix."""
    rows, columns = b.values.size()[:2]
    weights = b.values.matrix("weights")
    if weights is not None and "size" not in b.element.values and weights.ndim == 2:
        rows, columns = weights.shape
    came, dims = b.of((1, rows)), b.of((1, columns))
    if weights is None or weights.size != rows * columns:
        raise Unfit(f"its weights are not of the size {[rows, columns]}")
    ours = weights.reshape(rows, columns).T.reshape(shape(axes(dims)) + shape(axes(came)))
    element = Weights(ours, axes(dims), name=b.label)
    return Piece([element], [[Inlet(b.label, came, whole=True)]], {"output": Outlet(b.label, dims)}, needs=1, why="Weights")


def adaptive_weight_matrix(b: Bench) -> Piece:
    """AdaptiveWeightMatrix: its rate is per step, and its weights are not in the file; they begin at 0, as in cosivina."""
    rows, columns = b.values.size()[:2]
    came, dims = b.of((1, rows)), b.of((1, columns))
    gated = len(b.element.sources) > 2
    rate = b.values.number("learningRate", 0.1, 0) / b.step
    if b.step != 1 and "learningRate" in b.element.values:
        b.values.say("learningRate", "carried", f"divided by the step {b.step:g}, since cosivina's rate is per step")
    components = [s.component for s in b.element.sources[:2]]
    apart = len(set(components)) > 1 and b.bug(f"AdaptiveWeightMatrix learns from {components[1]!r} of its first input instead of {components[0]!r}")
    element = AdaptiveWeights(axes(dims), rate, 0.0, gated, apart, name=b.label)
    pre = [Inlet(b.label, came, "pre", whole=True, component=components[1])] if apart else []
    inlets = [[Inlet(b.label, came, whole=True), *pre], [Inlet(b.label, dims, "post")], *([[Inlet(b.label, (None, None), "gate")]] if gated else [])]
    why = "AdaptiveWeights, from weights of 0"
    elsewhere = {"weights": f"Session.keep writes them to the parameter {display((b.label, 'start'))}"}
    return Piece([element], inlets, {"output": Outlet(b.label, dims)}, elsewhere=elsewhere, needs=1, why=why)


CLASSES = {"WeightMatrix": weight_matrix, "AdaptiveWeightMatrix": adaptive_weight_matrix}
