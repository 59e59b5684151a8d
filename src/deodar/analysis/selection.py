"""Selection: whether two inputs lead to one peak."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deodar.analysis.isolated import Isolated
from deodar.analysis.peaks import Peaks
from deodar.analysis.settle import LIMIT
from deodar.errors import AnalysisError, ParameterError
from deodar.summary import Summarised, Summary, counted

HEAD_START = 0.01
DISTANCE = 0.5
"""Distance of the two inputs, as a share of each axis' range."""
FARTHEST = 0.5
"""Largest distance of two inputs that is tried, as a share of each axis' range: the largest one possible on a
periodic axis.
"""


@dataclass(frozen=True, repr=False)
class Selection(Summarised):
    """The response of a field to two inputs.

    Attributes:
        selects: whether both equal and different inputs lead to one peak.
        equal: peaks for two inputs of the same strength.
        different: peaks for two inputs of which the first is stronger.
        right: whether the peak for different inputs is at the position of the stronger one; None unless the
            field has exactly one peak.
        left: peaks after both inputs are removed.
        activation: the settled pattern for two equal inputs.
    """

    selects: bool
    equal: Peaks
    different: Peaks
    right: bool | None
    left: Peaks
    activation: np.ndarray

    def _summary(self) -> Summary:
        place = {True: "at the stronger input", False: "not at the stronger input", None: ""}[self.right]
        rows = [
            ("two equal inputs", counted(len(self.equal), "peak"), ""),
            ("two different inputs", counted(len(self.different), "peak"), place),
            ("after both", counted(len(self.left), "peak"), ""),
        ]
        return Summary("Selection" if self.selects else "No selection", rows)


def selection(
    isolated: Isolated,
    amplitude: float,
    difference: float = 0.1,
    distance: float = DISTANCE,
    limit: float = LIMIT,
) -> Selection:
    """Measure whether two simultaneous inputs lead to one peak.

    Without noise two equal inputs would stay balanced even where the balance is unstable. The first one is
    therefore stronger by a hundredth until the field settles; then both are equal and the field settles
    again.

    Args:
        isolated: a field with at least one axis.
        amplitude: amplitude of each input, above the detection threshold.
        difference: for the unequal pair, excess of the first input relative to the amplitude; >= 0.
        distance: distance of the inputs, as a share of each axis' range; above 0, below 1.
        limit: longest settling, in time constants.

    Raises:
        AnalysisError: if the field is a node.

    Reference:
        Schöner, Spencer & the DFT Research Group (2016), Dynamic Thinking, chapter 2 (selection instability).
    """
    if not isolated.axes:
        raise AnalysisError("a node cannot select between places", where=isolated.path)
    if not 0 < distance < 1 or not difference >= 0:
        raise ParameterError(
            f"distance is {distance} (above 0, below 1), difference {difference} (0 or above)"
        )
    home = isolated.session.get("input.center")
    try:
        first, second = places(isolated, distance)
        isolated.session.set("input.center", first)
        isolated.session.set("second.center", second)
        isolated.reset(input=amplitude * (1 + difference), second=amplitude)
        isolated.settle(limit=limit)
        different = isolated.peaks()
        equal, activation = _equal(isolated, amplitude, limit), isolated.activation()
        isolated.put(input=0.0, second=0.0)
        isolated.settle(limit=limit)
        left = isolated.peaks()
    finally:
        isolated.session.set("input.center", home)
        isolated.session.set("second.center", home)
    right = None
    if len(different) == 1:
        right = _apart(isolated, different[0].position, first) < _apart(
            isolated, different[0].position, second
        )
    return Selection(len(equal) == 1 and len(different) == 1, equal, different, right, left, activation)


def separation(isolated: Isolated, amplitude: float, limit: float = LIMIT) -> float | None:
    """Return the smallest distance, as a share of each axis' range, at which two equal inputs both keep a
    peak.

    Nearer inputs merge into one peak, or one of them is selected. The distance is found to one sample, by
    bisection. None if both inputs keep a peak at no distance.

    Args:
        isolated: a field with at least one axis.
        amplitude: amplitude of each input, above the detection threshold.
        limit: longest settling, in time constants.
    """
    home = isolated.session.get("input.center")

    def both(distance: float) -> bool:
        for name, place in zip(("input", "second"), places(isolated, distance), strict=True):
            isolated.session.set(f"{name}.center", place)
        return len(_equal(isolated, amplitude, limit)) >= 2

    near, far = 0.0, FARTHEST
    try:
        if not both(far):
            return None
        while far - near > 1.0 / min(a.samples for a in isolated.axes):
            middle = (near + far) / 2
            near, far = (near, middle) if both(middle) else (middle, far)
    finally:
        isolated.session.set("input.center", home)
        isolated.session.set("second.center", home)
    return far


def _equal(isolated: Isolated, amplitude: float, limit: float) -> Peaks:
    """Settle the field with two equal inputs; the first is stronger by a hundredth until it settles."""
    isolated.reset(input=amplitude * (1 + HEAD_START), second=amplitude)
    isolated.settle(limit=limit)
    isolated.put(input=amplitude)
    isolated.settle(limit=limit)
    return isolated.peaks()


def places(isolated: Isolated, distance: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return two samples at equal distances on both sides of the middle."""
    steps = [max(1, round(distance * a.samples / 2)) for a in isolated.axes]
    middle = [a.samples // 2 for a in isolated.axes]
    first = tuple(
        float(a.points[max(0, m - k)]) for a, m, k in zip(isolated.axes, middle, steps, strict=True)
    )
    second = tuple(
        float(a.points[min(a.samples - 1, m + k)])
        for a, m, k in zip(isolated.axes, middle, steps, strict=True)
    )
    return first, second


def _apart(isolated: Isolated, a: tuple[float, ...], b: tuple[float, ...]) -> float:
    total = 0.0
    for axis, p, q in zip(isolated.axes, a, b, strict=True):
        d = p - q
        d -= axis.range * round(d / axis.range) if axis.periodic else 0.0
        total += (d / axis.range) ** 2
    return total
