"""Connections of dnf-composer: one from each source. Only numbers of samples must agree, and a plane is read
row after row.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from deodar.couplings.weights import Weights
from deodar.element import Element
from deodar.importers.report import Line, Verdict
from deodar.numerics.axes import shape
from deodar_interop.importers._foreign import Foreign, FreeNames, Source
from deodar_interop.importers._piece import Dims, Piece, Unfit, axes, projection
from deodar_interop.importers._wiring import SourceWiring
from deodar_interop.importers.dnf_composer.element import ValueBudget
from deodar_interop.importers.dnf_composer.file import StoredSimulation
from deodar_interop.importers.dnf_composer.values import input_length, size

TEACHING = ("target", "target:activation")
"""Components by which a `field coupling` reads what it should learn."""

ANY_SIZE = ("resize", "resize 2d", "collapse", "expand")
"""Labels that take exactly one input, of any size."""


def admitted(simulation: StoredSimulation) -> tuple[StoredSimulation, list[Line]]:
    """Return the simulation with the connections that dnf-composer makes, and the report of the others."""
    lines: list[Line] = []
    elements = tuple(
        dc.replace(e, sources=tuple(_sources(simulation, e, lines))) for e in simulation.elements
    )
    return dc.replace(simulation, elements=elements), lines


def _sources(simulation: StoredSimulation, e: Foreign, lines: list[Line]) -> list[Source]:
    taken: set[str] = set()
    out: list[Source] = []
    for s in e.sources:
        why = _refused(e, s, simulation.by_label[s.label], taken, bool(out))
        taken.add(s.label)
        if why:
            lines.append(Line(e.label, "connection", f"{s.label}.{s.component}", "dropped", why))
        else:
            out.append(s)
    return out


def _refused(e: Foreign, s: Source, source: Foreign, taken: set[str], full: bool) -> str:
    """Return why a connection is not made; "" if it is."""
    if s.label in taken:
        return "a second connection between both elements; dnf-composer makes the first"
    if e.kind == "field coupling" and s.component in TEACHING:
        return "a signal for learning, which is off when a file is opened"
    if e.kind in ANY_SIZE:
        return f"{e.kind} takes one input" if full else ""
    arriving = math.prod(size(source))
    needed = input_length(e) if "coupling" in e.kind else math.prod(size(e))
    return "" if arriving == needed else f"its size does not fit: {arriving} samples into {needed}"


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
