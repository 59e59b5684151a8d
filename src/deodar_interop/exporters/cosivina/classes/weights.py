"""Weights, fixed and learning."""

from __future__ import annotations

import math

import numpy as np

from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights, RewardGate
from deodar.couplings.weights import Weights
from deodar.numerics.axes import cell, shape
from deodar.parameters import FrozenArray
from deodar_interop.exporters.cosivina.draft import Given, Unwritable
from deodar_interop.exporters.cosivina.inverse import inverse
from deodar_interop.exporters.cosivina.layout import is_row
from deodar_interop.importers.cosivina.classes.weights import REWARDED

ROWS = "cosivina has weights from a row to a row; put a Project before and behind them"


def weights(b: Given, element: Weights) -> None:
    """Write WeightMatrix."""
    if not isinstance(element.weights, FrozenArray):
        raise Unwritable("its weights are in another file, which is not loaded")
    if not is_row(b.dims()) or not is_row(b.dims("input")):
        raise Unwritable(ROWS)
    came = b.axes("input")
    rows, columns = math.prod(shape(came)), math.prod(shape(b.axes()))
    given = np.asarray(element.weights.data, np.float64).reshape(columns, rows).T
    matrix = given if cell(came) == 1 else given * cell(came)
    b.carry(b.part("WeightMatrix", {"size": [rows, columns], "weights": matrix.tolist()}))


def adaptive(b: Given, element: AdaptiveWeights) -> None:
    """Write AdaptiveWeightMatrix, whose rate is per step and whose weights begin at 0."""
    if not is_row(b.dims()) or not is_row(b.dims("input")):
        raise Unwritable(ROWS)
    if cell(b.axes("input")) != 1:
        raise Unwritable("cosivina learns weights of samples; its axes here have another step than 1")
    if element.initial or element.start is not None:
        b.say("start" if element.start is not None else "initial", "dropped", "cosivina begins with 0")
        b.approximate("its weights begin at 0")
    step = b.draft.step
    rate = inverse(lambda v: v / step, element.rate, element.rate * step)
    rows, columns = math.prod(shape(b.axes("input"))), math.prod(shape(b.axes()))
    part = b.part("AdaptiveWeightMatrix", {"size": [rows, columns], "learningRate": rate})
    if element.apart:
        b.approximate("it learns from another port than it reads, which cosivina does by an error alone")
    for slot, port in enumerate(("input", "post", *(("gate",) if element.gated else ()))):
        b.take(part, port, slot)
    b.show(part)
    b.show(part, "weights", "weights")


def hebbian(b: Given, element: Hebbian) -> None:
    """Write HebbianConnection, whose weights begin at 0."""
    if element.rule not in ("instar", "outstar"):
        raise Unwritable(f"cosivina has no rule {element.rule!r}; it has instar and outstar")
    lost = [
        name
        for name in ("decay", "saturation", "threshold", "initial", "random", "start")
        if getattr(element, name)
    ]
    for name in lost:
        b.say(name, "dropped", "cosivina's HebbianConnection does not have it")
    b.approximate("cosivina saves one or two of its parameters, and its weights begin at 0")
    values = {"learningRate": element.rate, "tau": 1, "tauDecay": 1, "instar": int(element.rule == "outstar")}
    part = b.part("HebbianConnection", values)
    b.take(part)
    b.take(part, "post", 1)
    gates = [e for e in b.draft.followers(b.id, "reward") if isinstance(e.element, RewardGate)]
    if element.gated and len(gates) == 1:
        gate = gates[0].element
        assert isinstance(gate, RewardGate)
        if gate.threshold != REWARDED or gate.graded or gate.gated or gate.strength != 1:
            b.approximate(f"a reward counts above {REWARDED:g}")
        b.claim(gates)
        part.values["rewardDuration"] = [0, gate.duration] if gate.duration else [-1, -1]
        b.take(part, "input", 2, of=gates[0].id)
    elif element.gated:
        b.take(part, "gate", 2)
    b.show(part)
    b.show(part, "weights", "weights")


KINDS = {Weights: weights, AdaptiveWeights: adaptive, Hebbian: hebbian}
