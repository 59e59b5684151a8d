"""The strength of noise from the fluctuations that it causes."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deodar.numerics.axes import Axis, cell


def strength(still: float, tau: float, axes: Sequence[Axis]) -> float:
    """Return the strength at which a field's noise has a standard deviation at each sample, without
    interaction.

    Args:
        still: the standard deviation.
        tau: time constant of the field.
        axes: its axes; none for a node.
    """
    return still * math.sqrt(2 * tau * cell(axes))
