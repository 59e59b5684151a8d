"""Translate a simulation of dnf-composer: elements, connections in the order of the file, and a report."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from pathlib import PurePath

import numpy as np

from deodar.couplings.arithmetic import Sum
from deodar.elements.placeholder import Placeholder
from deodar.elements.stimuli import Pattern
from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import Line
from deodar.numerics.axes import shape
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._piece import Inlet, Outlet, Piece, axes
from deodar_interop.importers._translation import ListTranslation, component_lines
from deodar_interop.importers.dnf_composer import element, file
from deodar_interop.importers.dnf_composer.classes import CLASSES
from deodar_interop.importers.dnf_composer.element import StoredElement, ValueBudget
from deodar_interop.importers.dnf_composer.file import StoredSimulation
from deodar_interop.importers.dnf_composer.values import SampleAxes, size
from deodar_interop.importers.dnf_composer.wiring import FlatWiring, admitted

MISSING = {"field projection": "a reduction or an expansion of 2026, which collapse and expand replaced"}
"""What each label that is not translated was."""


def read(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that the content of a file describes, and the report.

    Args:
        content: the content of the file.
        name: name of the file, for the report, and for the model's name if the file states none.
        bugs: without effect: no result of dnf-composer is corrected.
        beside: reads the weights of couplings, which lie in the folder of the file.
    """
    simulation = file.parse(content)
    with np.errstate(all="ignore"):  # what is not finite is reported, or refused by an element
        translation = SimulationTranslation(simulation, beside)
    doc = translation.document(simulation.name or PurePath(name).stem)
    return translation.imported(doc, name, simulation.step)


class SimulationTranslation(ListTranslation[StoredElement]):
    """The translations of a file's elements by label, their connections, and the report lines."""

    tool, word, classes, missing = "dnf-composer", "label", CLASSES, MISSING

    def __init__(self, simulation: StoredSimulation, beside: Beside) -> None:
        self.kinds = {e.label: e.kind for e in simulation.elements}
        renamed = [file.modern(e) for e in simulation.elements]
        self.old = {e.label: lines for e, lines in renamed}
        modern = dc.replace(simulation, elements=tuple(e for e, _ in renamed))
        self.simulation, refused = admitted(modern)
        super().__init__(self.simulation.elements, SampleAxes(self.simulation))
        self.report += simulation.lines
        self.budget, self.beside = ValueBudget(), beside
        self.contexts: dict[str, StoredElement] = {}
        self.pieces = {e.label: self.piece(e) for e in self.simulation.elements}
        connected = self.add_inputs_of_stimuli()
        self.wiring = FlatWiring(connected, self.pieces, self.names, self.budget)
        self.wiring.connect_all()
        self.report += refused

    def context(self, e: Foreign) -> StoredElement:
        read = self.components_read[e.label]
        b = StoredElement(self.simulation, self.length_axes, e, read, self.names, self.budget, self.beside)
        self.contexts[e.label] = b
        return b

    def size(self, e: Foreign) -> Sequence[int]:
        return size(e)

    def kind(self, e: Foreign) -> str:
        return self.kinds[e.label]

    def placeholder(self, e: Foreign, why: str = "") -> Piece:
        b = self.contexts[e.label]
        b.start, b.levels = 0.0, {}
        return super().placeholder(e, why)

    def finished(self, b: StoredElement, piece: Piece) -> tuple[Piece, list[Line]]:
        e = b.element
        if self.kind(e) != e.kind:
            piece.verdict = "approximated"
            piece.why += f", as {e.kind}; today's dnf-composer has no such label"
        piece = _with_input(b, piece)
        components = dict.fromkeys((*piece.outlets, *piece.elsewhere))
        return piece, [*self._parameters(b), *b.extra, *component_lines(e, piece, components)]

    def _parameters(self, b: StoredElement) -> list[Line]:
        """Return the lines of the parameters; those of an older form keep their names of then."""
        old = self.old[b.label]
        as_now = {file.RENAMED[line.what] for line in old if line.verdict == "approximated"}
        return [*old, *(line for line in b.values.rest(b.element.kind) if line.what not in as_now)]

    def add_inputs_of_stimuli(self) -> list[Foreign]:
        """Add to each stimulus the sum of its inputs at the start; return the elements without them."""
        sums = element.added(self.simulation.elements, self.contexts)
        out: list[Foreign] = []
        for e in self.simulation.elements:
            if e.kind not in element.ADDING or isinstance(self.pieces[e.label].elements[0], Placeholder):
                out.append(e)
                continue
            verdict, why = "carried", "added once, at the start"
            if e.label not in sums:
                verdict, why = "dropped", "the arrays of the file have too many values"
            self.report += [
                Line(e.label, "connection", f"{s.label}.{s.component}", verdict, why) for s in e.sources
            ]
            if e.label in sums and sums[e.label].any():
                self.pieces[e.label] = _plus(self.contexts[e.label], self.pieces[e.label], sums[e.label])
            out.append(dc.replace(e, sources=()))
        return out


def _plus(b: StoredElement, piece: Piece, values: np.ndarray) -> Piece:
    """Return a stimulus plus a constant."""
    outlet = piece.outlets["output"]
    constant_axes = axes(outlet.dims)
    alone = dc.replace(piece.elements[0], name=b.named("alone"))
    constant = Pattern(b.named("inputs"), constant_axes, values.reshape(shape(constant_axes)))
    return dc.replace(
        piece,
        elements=[Sum(name=b.label), alone, constant],
        inner=[(alone.name, b.label), (constant.name, b.label)],
    )


def _with_input(b: StoredElement, piece: Piece) -> Piece:
    """Return a translation whose input is an element of its own, if another element reads it."""
    if "input" not in b.components_read or not piece.inlets:
        return piece
    inlet = piece.inlets[0][0]
    name = b.named("input")
    return dc.replace(
        piece,
        elements=[*piece.elements, Sum(name=name)],
        inlets=[[Inlet(name, inlet.dims, whole=True)]],
        inner=[*piece.inner, (name, inlet.name, inlet.port)],
        outlets={**piece.outlets, "input": Outlet(name, inlet.dims)},
        needs=1,
    )
