"""Connections of dnf-composer: only numbers of samples must agree, and a plane is read row after row."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np

from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.importers._piece import Dims, axes, projection
from deodar.importers._wiring import SourceWiring
from deodar.importers.report import Verdict
from deodar.numerics.axes import shape

MOST_FLAT = 2500
"""Largest number of samples that are read in another shape, by a matrix of this size squared."""


class FlatWiring(SourceWiring):
    """The connections of a simulation; an element without inputs reads zero there too."""

    without_input: ClassVar[Verdict] = "carried"

    def compatible(self, given: Dims, wanted: Dims) -> bool:
        counts = [math.prod(shape(axes(dims))) for dims in (given, wanted)]
        return counts[0] == counts[1] and (_alike(given, wanted) or counts[0] <= MOST_FLAT)

    def adapter(self, name: str, given: Dims, wanted: Dims) -> Element:
        if _alike(given, wanted):
            return projection(name, axes(given), wanted, axes(wanted))
        counts = shape(axes(wanted)) + shape(axes(given))
        return Weights(np.eye(math.prod(shape(axes(given)))).reshape(counts), axes(wanted), name=name)


def _alike(given: Dims, wanted: Dims) -> bool:
    """Return whether two sizes are the same, dimensions of one sample aside."""
    return shape(axes(given)) == shape(axes(wanted))
