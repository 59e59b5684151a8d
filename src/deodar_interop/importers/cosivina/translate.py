"""Translate a file of cosivina to a model: elements, connections in the order of the file, and a report."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath

from deodar.elements.placeholder import Placeholder
from deodar.errors import DeodarError
from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.paths import display
from deodar_interop.importers._axes import SizeLimit
from deodar_interop.importers._document import assembled
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._names import FreeNames
from deodar_interop.importers._piece import Piece, Unfit
from deodar_interop.importers._wiring import SourceWiring
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.classes import CLASSES
from deodar_interop.importers.cosivina.classes.missing import placeholder
from deodar_interop.importers.cosivina.components import components
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import Simulator
from deodar_interop.importers.cosivina.sizes import Dimensions


def read(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that the content of a file describes, and the report.

    Args:
        content: the content of the file.
        name: name of the file, for the model's name and the report.
        bugs: whether to reproduce known errors of cosivina instead of correcting them.
        beside: not used: a file of cosivina needs no other files.
    """
    return translated(file.parse(content), name, bugs)


def translated(simulator: Simulator, name: str, bugs: bool, finish: Finish | None = None) -> Imported:
    """Return the model of a simulator, and the report.

    Args:
        simulator: the content of a file.
        name: name of the file.
        bugs: whether to reproduce known errors of cosivina.
        finish: adds to the document what else the file holds, and returns report lines about it.
    """
    translation = Translation(simulator, bugs)
    doc = Document(PurePath(name).stem or "cosivina")
    elements = [element for piece in translation.pieces.values() for element in piece.elements]
    doc = assembled(doc, elements + translation.wiring.extra, translation.wiring.connections)
    lines: list[Line] = []
    if finish is not None:
        doc, lines = finish(translation, doc)
    report = ImportReport("cosivina", name, [*translation.lines(), *lines], translation.met)
    doc = edit.describe(doc, time_unit="ms", dt=simulator.step, t0=simulator.start, notes=report.text())
    return Imported(Model(document=doc), report)


Finish = Callable[["Translation", Document], tuple[Document, list[Line]]]
"""Adds to a document, and returns it with report lines."""


class Translation:
    """The translations of a file's elements by label, their connections, and the report lines."""

    def __init__(self, simulator: Simulator, bugs: bool) -> None:
        self.simulator = simulator
        self.bugs = bugs
        self.dimensions = Dimensions(simulator)
        self.met: list[str] = []
        self.report: list[Line] = []
        self.names = FreeNames(e.label for e in simulator.elements)
        self.components_read: dict[str, set[str]] = {}
        for e in simulator.elements:
            for s in e.sources:
                self.components_read.setdefault(s.label, set()).add(s.component)
        self.pieces = {e.label: self.piece(e) for e in simulator.elements}
        self.wiring = SourceWiring("cosivina", simulator.elements, self.pieces, self.names)
        self.wiring.connect_all()

    def piece(self, e: Foreign) -> Piece:
        """Return the translation of one element, or a placeholder if it has none or its parameters contradict
        each other.
        """
        source = SourceElement(
            self.simulator,
            self.dimensions,
            e,
            self.components_read.get(e.label, set()),
            self.names,
            self.bugs,
        )
        try:
            piece = (
                CLASSES[e.kind](source)
                if e.kind in CLASSES
                else placeholder(e, self.dimensions, list(CLASSES))
            )
        except (Unfit, SizeLimit) as error:
            piece = placeholder(e, self.dimensions, list(CLASSES), str(error))
        except (DeodarError, ValueError, TypeError, IndexError, OverflowError) as error:
            piece = placeholder(
                e, self.dimensions, list(CLASSES), f"its parameters are inconsistent ({error})"
            )
        self.met += source.met
        self.report.append(Line(e.label, "element", e.kind, piece.verdict, piece.why))
        if isinstance(piece.elements[0], Placeholder):
            self.report += [
                Line(e.label, "parameter", name, "dropped", "its element is a placeholder")
                for name in e.values
            ]
        else:
            self.report += source.values.rest(e.kind)
            self.report += _shown(e, piece)
        return piece

    def lines(self) -> list[Line]:
        """Return all lines of the report."""
        return [*self.simulator.lines, *self.report, *self.wiring.lines]


def _shown(e: Foreign, piece: Piece) -> list[Line]:
    """Report the ports of an element's components, which scripts and plots of cosivina read by name.

    Components with the same name in deodar are left out.
    """
    lines: list[Line] = []
    for component in components(e.kind):
        outlet = piece.outlets.get(component)
        if outlet is not None:
            if (outlet.name, outlet.port) != (e.label, component):
                lines.append(
                    Line(
                        e.label,
                        "component",
                        component,
                        "carried",
                        f"read {display((outlet.name, outlet.port))}",
                    )
                )
        elif component in piece.elsewhere:
            lines.append(Line(e.label, "component", component, "carried", piece.elsewhere[component]))
        else:
            lines.append(Line(e.label, "component", component, "dropped", "no element here outputs it"))
    return lines
