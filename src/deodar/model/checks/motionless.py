"""States that change by less than single precision can store."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from deodar.elements.field import Field
from deodar.elements.populations import RateNode
from deodar.elements.variables import Integrator
from deodar.errors import Problem, option
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring

LEAST = 2.0
"""Units in the last place that a step has to change a state by, else it is rounded by more than a quarter."""

SMALL = 1e-3
"""Sum of inputs, as a share of the value at the start, from which it matters that they move it (a guess)."""

SMALLEST = 0.1
"""Sum of inputs that a run looks for: if none of this size leaves an element where it is, it skips the bounds
of all signals, which cost time (a guess).
"""

LARGEST = float(np.finfo(np.float32).max)
"""Largest number of single precision."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Report elements that do not move in single precision, at the document's step."""
    return _motionless(wiring, wiring.doc.step)


def motionless(doc: Document, step: float) -> list[Problem]:
    """Return the elements that do not move in single precision, at a step."""
    nodes = graph(doc).nodes
    if graph(doc).problems or not any(_share(n, step) * SMALLEST < LEAST * _spacing(n) for n in nodes):
        return []
    return list(_motionless(Wiring(doc, nodes), step))


def _motionless(wiring: Wiring, step: float) -> Iterator[Problem]:
    for n in wiring.declared:
        drive = max(map(abs, wiring.arriving(n)))
        change, spacing = _share(n, step) * drive, _spacing(n)
        matters = SMALL * abs(_begin(n)) < drive < math.inf
        if matters and 0 < change < LEAST * spacing and not _shaken(n, step, spacing):
            sentence = (
                f"does not move in single precision: a step changes it by at most {change:.2g}, and numbers"
                f" near {_begin(n):g} lie {spacing:.2g} apart"
            )
            precision = ("precision", "float64", '"float64"', "with a script or a command")
            fix = option("Compute in double precision:", *precision)
            yield Problem(n.path, sentence, fix, "warning")


def _begin(n: Node) -> float:
    """Return the value that an element begins with; 0 of kinds without one."""
    e = n.element
    if isinstance(e, (Field, RateNode)):
        return e.resting_level
    return e.initial if isinstance(e, Integrator) and e.start is None else 0.0


def _spacing(n: Node) -> float:
    """Return the distance of neighbouring numbers of single precision where an element begins; near 0 there
    is none.
    """
    begin = abs(_begin(n))
    # one that is too large is refused where it is written to the program
    return float(np.spacing(np.float32(begin))) if 0 < begin <= LARGEST else 0.0


def _share(n: Node, step: float) -> float:
    """Return the share of its inputs by which an element changes in a step."""
    e = n.element
    if isinstance(e, (Field, RateNode)):
        return step * n.every / e.tau
    return step * n.every * abs(e.rate) if isinstance(e, Integrator) else math.inf


def _shaken(n: Node, step: float, spacing: float) -> bool:
    """Return whether noise carries an element over the rounding."""
    e = n.element
    return isinstance(e, (Field, RateNode)) and math.sqrt(step * n.every) / e.tau * e.noise > spacing
