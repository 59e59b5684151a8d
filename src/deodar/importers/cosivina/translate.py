"""From a file of cosivina to a model: pieces for the elements, connections in the order of the file, a report."""

from __future__ import annotations

from pathlib import PurePath

from deodar.element import Element
from deodar.elements.placeholder import Placeholder
from deodar.errors import DeodarError
from deodar.importers.cosivina import file
from deodar.importers.cosivina.classes import CLASSES
from deodar.importers.cosivina.classes.missing import placeholder
from deodar.importers.cosivina.connect import Wiring
from deodar.importers.cosivina.file import Foreign, Simulator
from deodar.importers.cosivina.piece import Bench, Piece, Unfit
from deodar.importers.cosivina.sizes import Dimensions, TooLarge
from deodar.importers.imported import Imported
from deodar.importers.report import Line, Report
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model


def read(content: bytes, name: str, bugs: bool = False) -> Imported:
    """The model that the content of a file describes, and the report.

    Args:
        content: the file.
        name: what the file is called, for the model's name and the report.
        bugs: whether known errors of cosivina are reproduced instead of corrected.
    """
    simulator = file.parse(content)
    translation = Translation(simulator, bugs)
    report = Report("cosivina", name, translation.lines(), translation.met)
    title = PurePath(name).stem
    doc = edit.describe(Document(title or "cosivina"), time_unit="ms", dt=simulator.step, t0=simulator.start, notes=report.text())
    doc, ids = _add(doc, [element for piece in translation.pieces.values() for element in piece.elements] + translation.wiring.extra)
    by = doc.by_id()
    for source, port, target, entrance, reads in translation.wiring.connections:
        doc = edit.connect(doc, by[ids[source]], port, by[ids[target]], entrance, reads)
    return Imported(Model(document=doc), report)


class Translation:
    """The pieces of a file by label, their wiring, and what is to be said."""

    def __init__(self, simulator: Simulator, bugs: bool) -> None:
        self.simulator = simulator
        self.bugs = bugs
        self.dimensions = Dimensions(simulator)
        self.met: list[str] = []
        self.said: list[Line] = []
        self.taken = {e.label for e in simulator.elements}
        self.asked: dict[str, set[str]] = {}
        for e in simulator.elements:
            for s in e.sources:
                self.asked.setdefault(s.label, set()).add(s.component)
        self.pieces = {e.label: self.piece(e) for e in simulator.elements}
        self.wiring = Wiring(simulator, self.pieces, self.taken)
        self.wiring.connect_all()

    def piece(self, e: Foreign) -> Piece:
        """The counterpart of one element; a placeholder where there is none, or where its parameters do not go together."""
        bench = Bench(self.simulator, self.dimensions, e, self.asked.get(e.label, set()), self.taken, self.bugs)
        try:
            found = CLASSES[e.kind](bench) if e.kind in CLASSES else placeholder(e, self.dimensions, list(CLASSES))
        except (Unfit, TooLarge) as error:
            found = placeholder(e, self.dimensions, list(CLASSES), str(error))
        except (DeodarError, ValueError, TypeError, IndexError, OverflowError) as error:
            found = placeholder(e, self.dimensions, list(CLASSES), f"its parameters do not go together ({error})")
        self.met += bench.met
        self.said.append(Line(e.label, "element", e.kind, found.verdict, found.why))
        if isinstance(found.elements[0], Placeholder):
            self.said += [Line(e.label, "parameter", name, "dropped", "its element is a placeholder") for name in e.values]
        else:
            self.said += bench.values.rest()
        return found

    def lines(self) -> list[Line]:
        """All lines of the report."""
        return [*self.simulator.lines, *self.said, *self.wiring.lines]


def _add(doc: Document, elements: list[Element]) -> tuple[Document, dict[str, str]]:
    ids: dict[str, str] = {}
    for element in elements:
        doc, entry = edit.add(doc, element)
        ids[element.name] = entry.id
    return doc, ids
