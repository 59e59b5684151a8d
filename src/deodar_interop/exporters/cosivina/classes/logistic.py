"""The logistic sigmoid that stands for another one."""

from __future__ import annotations

from deodar.numerics.sigmoids import Absolute, Logistic, SigmoidFunction, Step
from deodar_interop.exporters.cosivina.draft import Given

STEEP = 1000.0
"""Steepness of the logistic sigmoid that stands for a step."""


def logistic(b: Given, found: SigmoidFunction) -> tuple[float, float]:
    """Return the steepness and the threshold of the logistic sigmoid that cosivina has.

    One with the same slope at the threshold stands for an `Absolute`, a steep one for a `Step`.
    """
    kind, threshold = type(found).__name__, float(getattr(found, "threshold", 0.0))
    if isinstance(found, Logistic):
        return found.beta, threshold
    if isinstance(found, (Absolute, Step)):
        beta = 2 * found.beta if isinstance(found, Absolute) else STEEP
        b.say("sigmoid", "approximated", f"cosivina has the Logistic; beta {beta:g} stands for the {kind}")
        b.approximate(f"a Logistic stands for its {kind}")
        return beta, threshold
    b.say("sigmoid", "dropped", f"cosivina has the Logistic alone; its default stands for the {kind}")
    b.approximate(f"its sigmoid is not the {kind}")
    return Logistic().beta, threshold
