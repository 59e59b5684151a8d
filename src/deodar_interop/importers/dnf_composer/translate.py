"""Translate a simulation of dnf-composer: elements, connections in the order of the file, and a report."""

from __future__ import annotations

import dataclasses as dc
from pathlib import PurePath

import numpy as np

from deodar.couplings.sum import Sum
from deodar.elements.pattern import Pattern
from deodar.elements.placeholder import Placeholder
from deodar.errors import DeodarError
from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.paths import display
from deodar.numerics.axes import shape
from deodar_interop.importers._axes import SizeLimit
from deodar_interop.importers._document import assembled
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._names import FreeNames
from deodar_interop.importers._piece import Inlet, Outlet, Piece, Unfit, axes
from deodar_interop.importers.dnf_composer import file, legacy, start
from deodar_interop.importers.dnf_composer.classes import CLASSES
from deodar_interop.importers.dnf_composer.classes.missing import placeholder
from deodar_interop.importers.dnf_composer.element import StoredElement, ValueBudget
from deodar_interop.importers.dnf_composer.file import StoredSimulation
from deodar_interop.importers.dnf_composer.links import admitted
from deodar_interop.importers.dnf_composer.sizes import SampleAxes
from deodar_interop.importers.dnf_composer.wiring import FlatWiring


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
    report = ImportReport("dnf-composer", name, translation.lines())
    title = simulation.name or PurePath(name).stem
    doc = edit.describe(
        Document(title or "dnf-composer"), time_unit="ms", dt=simulation.step, t0=0.0, notes=report.text()
    )
    elements = [element for piece in translation.pieces.values() for element in piece.elements]
    doc = assembled(doc, elements + translation.wiring.extra, translation.wiring.connections)
    return Imported(Model(document=doc), report)


class SimulationTranslation:
    """The translations of a file's elements by label, their connections, and the report lines."""

    def __init__(self, simulation: StoredSimulation, beside: Beside) -> None:
        self.report: list[Line] = list(simulation.lines)
        self.kinds = {e.label: e.kind for e in simulation.elements}
        renamed = [legacy.modern(e) for e in simulation.elements]
        self.old = {e.label: lines for e, lines in renamed}
        simulation = dc.replace(simulation, elements=tuple(e for e, _ in renamed))
        self.simulation, refused = admitted(simulation)
        self.axes = SampleAxes(self.simulation)
        self.names = FreeNames(e.label for e in self.simulation.elements)
        self.components_read: dict[str, set[str]] = {}
        for e in self.simulation.elements:
            for s in e.sources:
                self.components_read.setdefault(s.label, set()).add(s.component)
        budget = ValueBudget()
        self.contexts = {
            e.label: StoredElement(
                self.simulation,
                self.axes,
                e,
                self.components_read.get(e.label, set()),
                self.names,
                budget,
                beside,
            )
            for e in self.simulation.elements
        }
        self.pieces = {e.label: self.piece(e) for e in self.simulation.elements}
        connected = self.add_inputs_of_stimuli()
        self.wiring = FlatWiring(connected, self.pieces, self.names, budget)
        self.wiring.connect_all()
        self.report += refused

    def piece(self, e: Foreign) -> Piece:
        """Return the translation of one element, or a placeholder if it has none or its parameters contradict
        each other.
        """
        b = self.contexts[e.label]
        kinds = list(CLASSES)
        try:
            piece = CLASSES[e.kind](b) if e.kind in CLASSES else placeholder(e, self.axes, kinds)
        except (Unfit, SizeLimit) as error:
            piece = placeholder(e, self.axes, kinds, str(error))
        except (DeodarError, ValueError, TypeError, IndexError, OverflowError) as error:
            piece = placeholder(e, self.axes, kinds, f"its parameters are inconsistent ({error})")
        missing = isinstance(piece.elements[0], Placeholder)
        verdict, why, kind = piece.verdict, piece.why, self.kinds[e.label]
        if kind != e.kind and not missing:
            verdict, why = "approximated", f"{why}, as {e.kind}; today's dnf-composer has no such label"
        self.report.append(Line(e.label, "element", kind, verdict, why))
        if missing:
            b.start, b.levels = 0.0, {}
            self.report += [
                Line(e.label, "parameter", name, "dropped", "its element is a placeholder")
                for name in e.values
            ]
            return piece
        piece = _with_input(b, piece)
        self.report += [*self._parameters(b), *b.extra, *_shown(e, piece)]
        return piece

    def _parameters(self, b: StoredElement) -> list[Line]:
        """Return the lines of the parameters; those of an older form keep their names of then."""
        old = self.old[b.label]
        as_now = {legacy.RENAMED[line.what] for line in old if line.verdict == "approximated"}
        return [*old, *(line for line in b.values.rest(b.element.kind) if line.what not in as_now)]

    def add_inputs_of_stimuli(self) -> list[Foreign]:
        """Add to each stimulus the sum of its inputs at the start; return the elements without them."""
        sums = start.added(self.simulation.elements, self.contexts)
        out: list[Foreign] = []
        for e in self.simulation.elements:
            if e.kind not in start.ADDING or isinstance(self.pieces[e.label].elements[0], Placeholder):
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

    def lines(self) -> list[Line]:
        """Return all lines of the report."""
        return [*self.report, *self.wiring.lines]


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


def _shown(e: Foreign, piece: Piece) -> list[Line]:
    """Report the components that are read elsewhere than under their names."""
    lines = [
        Line(e.label, "component", component, "carried", f"read {display((outlet.name, outlet.port))}")
        for component, outlet in piece.outlets.items()
        if (outlet.name, outlet.port) != (e.label, component)
    ]
    return lines + [
        Line(e.label, "component", component, "carried", where)
        for component, where in piece.elsewhere.items()
        if component not in piece.outlets
    ]
