"""Models that several tests of the studio open."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.couplings.weights import Weights


def weighted(seed: int = 1) -> dd.Model:
    """Return a model with an array."""
    model = dd.Model("m")
    u = model.add(dd.Field("u", [dd.Axis("x", 0, 9, samples=10)]))
    (
        u
        >> Weights(
            weights=np.random.default_rng(seed).normal(size=(10, 10)), axes=[dd.Axis("x", 0, 9, samples=10)]
        )
        >> u
    )
    return model
