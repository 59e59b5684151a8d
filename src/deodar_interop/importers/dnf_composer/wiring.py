"""Connections of dnf-composer: only numbers of samples must agree, and a plane is read row after row."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.importers.report import Verdict
from deodar.numerics.axes import shape
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._names import FreeNames
from deodar_interop.importers._piece import Dims, Piece, Unfit, axes, projection
from deodar_interop.importers._wiring import SourceWiring
from deodar_interop.importers.dnf_composer.element import ValueBudget

MOST_FLAT = 2500
"""Largest number of samples that are read in another shape, by a matrix of this size squared."""


class FlatWiring(SourceWiring):
    """The connections of a simulation; an element without inputs reads zero there too."""

    without_input: ClassVar[Verdict] = "carried"

    def __init__(
        self, elements: Sequence[Foreign], pieces: Mapping[str, Piece], names: FreeNames, budget: ValueBudget
    ) -> None:
        super().__init__("dnf-composer", elements, pieces, names)
        self.budget = budget

    def compatible(self, source: Dims, target: Dims) -> bool:
        counts = [math.prod(shape(axes(dims))) for dims in (source, target)]
        if counts[0] != counts[1] or _alike(source, target):
            return counts[0] == counts[1]
        if counts[0] > MOST_FLAT:
            return False
        try:
            self.budget.take(counts[0] ** 2)
        except Unfit:
            return False
        return True

    def adapter(self, name: str, source: Dims, target: Dims) -> Element:
        if _alike(source, target):
            return projection(name, axes(source), target, axes(target))
        counts = shape(axes(target)) + shape(axes(source))
        return Weights(np.eye(math.prod(shape(axes(source)))).reshape(counts), axes(target), name=name)


def _alike(first: Dims, second: Dims) -> bool:
    """Return whether two sizes are the same, dimensions of one sample aside."""
    return shape(axes(first)) == shape(axes(second))
