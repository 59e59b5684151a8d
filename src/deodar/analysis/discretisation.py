"""The dependence of thresholds on the grid: the same measurements on a grid twice as fine."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping

from deodar.analysis.isolated import Isolated, isolate
from deodar.analysis.settle import LIMIT
from deodar.analysis.thresholds import Transition, thresholds
from deodar.analysis.working_memory import forgetting, suppression
from deodar.elements.field import Field
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.custom import Custom

MOST = 20_000
"""Largest number of samples of the finer grid: about a minute on one core (a guess, from 75 microseconds for
a step of 100 x 100 samples).
"""


def refined(field: Field) -> Field:
    """Return the field with twice as many steps along each axis: 2 n - 1 samples, or 2 n on a periodic axis.

    The new samples include all samples of the field.
    """
    axes = [
        dc.replace(a, samples=2 * a.samples if a.periodic else 2 * a.samples - 1) if a.samples > 1 else a
        for a in field.axes
    ]
    return dc.replace(field, axes=tuple(axes))


def obstacle(isolated: Isolated) -> str:
    """Return the reason why a field is not measured on a finer grid; empty if it is measured."""
    fine: tuple[Axis, ...] = tuple(refined(isolated.field).axes)
    count = math.prod(a.samples for a in fine)
    if not fine:
        return "a node has no grid"
    if any(isinstance(k, Custom) for k in isolated.field.kernel):
        return "a custom kernel is given on this grid alone"
    if isolated.background:
        return "the inputs that are kept have the field's own grid"
    if count > MOST:
        return f"the grid twice as fine has {count} samples, more than {MOST}"
    return ""


def discretisation(
    isolated: Isolated,
    transitions: Mapping[str, Transition],
    strength: float,
    accuracy: float = 0.01,
    limit: float = LIMIT,
) -> dict[str, float | None]:
    """Return the shift of each threshold on a grid twice as fine: its value there minus its value here.

    None for a threshold that does not exist on the finer grid.

    Args:
        isolated: the field.
        transitions: its thresholds, by `detection`, `reverse`, `forgetting` and `suppression`, all or some
            of them.
        strength: localised input that creates the peak of a memory, relative to the detection threshold.
        accuracy: relative accuracy with which the thresholds were found.
        limit: longest settling, in time constants.
    """
    session = isolated.session
    fine = isolate(
        refined(isolated.field),
        sigma=isolated.sigma,
        center=isolated.center,
        precision=session.precision,
        dt=session.dt,
    )
    fine_thresholds = thresholds(fine, accuracy=accuracy, limit=limit)
    fine_transitions: dict[str, Transition | None] = {
        "detection": fine_thresholds.detection,
        "reverse": fine_thresholds.reverse,
    }
    if fine_thresholds.detection is not None:
        fine_strength = strength * fine_thresholds.detection.after
        for name, measure in (("forgetting", forgetting), ("suppression", suppression)):
            if name in transitions:
                fine_transitions[name] = measure(fine, fine_strength, accuracy, limit)
    return {
        name: t.value - coarse.value if (t := fine_transitions.get(name)) else None
        for name, coarse in transitions.items()
    }
