"""The connections that dnf-composer makes: one from each source, between elements of the same size."""

from __future__ import annotations

import dataclasses as dc
import math

from deodar.importers.report import Line
from deodar_interop.importers._foreign import Foreign, Source
from deodar_interop.importers.dnf_composer.file import StoredSimulation
from deodar_interop.importers.dnf_composer.sizes import input_length, size

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
