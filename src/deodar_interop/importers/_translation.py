"""The translation of a list of elements, and of the connections in its order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar, Generic, TypeVar

from deodar.elements.placeholder import Placeholder
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.paths import display
from deodar_interop.importers._axes import LengthAxes, SizeLimit
from deodar_interop.importers._element import ElementKind, FileElement
from deodar_interop.importers._foreign import Foreign, FreeNames
from deodar_interop.importers._missing import or_placeholder, placeholder_lines, unknown
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, axes
from deodar_interop.importers._wiring import SourceWiring

Context = TypeVar("Context", bound=FileElement)


class ListTranslation(Generic[Context]):
    """The translations of a file's elements by label, their connections, and the report lines.

    A subclass for a tool makes the context of an element, and sets `pieces` and `wiring`.

    Attributes:
        tool: name of the tool.
        word: what the tool calls the kind of an element.
        classes: translations by kind.
        missing: what the kinds that are not translated are.
    """

    tool: ClassVar[str]
    word: ClassVar[str]
    classes: ClassVar[Mapping[str, ElementKind]]
    missing: ClassVar[Mapping[str, str]]
    pieces: dict[str, Piece]
    wiring: SourceWiring

    def __init__(self, elements: Sequence[Foreign], length_axes: LengthAxes) -> None:
        self.length_axes = length_axes
        self.met: list[str] = []
        self.report: list[Line] = []
        self.names = FreeNames(e.label for e in elements)
        self.components_read: dict[str, set[str]] = {e.label: set() for e in elements}
        for e in elements:
            for s in e.sources:
                self.components_read.setdefault(s.label, set()).add(s.component)

    def context(self, e: Foreign) -> Context:
        """Return the context in which an element is translated."""
        raise NotImplementedError

    def size(self, e: Foreign) -> Sequence[int]:
        """Return the size of an element."""
        raise NotImplementedError

    def kind(self, e: Foreign) -> str:
        """Return the kind of an element as the file states it."""
        return e.kind

    def finished(self, b: Context, piece: Piece) -> tuple[Piece, list[Line]]:
        """Return a translation that is no placeholder, and lines about its parameters and components."""
        raise NotImplementedError

    def piece(self, e: Foreign) -> Piece:
        """Return the translation of one element, or a placeholder if it has none or its parameters contradict
        each other.
        """
        b = self.context(e)
        translate = self.classes.get(e.kind)
        piece = or_placeholder(
            lambda: self.placeholder(e) if translate is None else translate(b),
            lambda why: self.placeholder(e, why),
        )
        lines = placeholder_lines(e.label, e.values)
        if not isinstance(piece.elements[0], Placeholder):
            piece, lines = self.finished(b, piece)
        self.met += b.met
        self.report += [Line(e.label, "element", self.kind(e), piece.verdict, piece.why), *lines]
        return piece

    def placeholder(self, e: Foreign, why: str = "") -> Piece:
        """Return a placeholder for an element, with the reason."""
        unknown_kind = f"an unknown {self.word} of {self.tool}"
        missing = why or self.missing.get(e.kind, "") or unknown(e.kind, unknown_kind, list(self.classes))
        try:
            dims: Dims = self.length_axes.of(self.size(e))
        except SizeLimit:
            dims = (None, None)
        return Piece(
            [Placeholder(e.label, axes(dims), f"{e.kind}: {missing}")],
            [[Inlet(e.label, dims)]],
            {"output": Outlet(e.label, dims, state=True)},
            sums=True,
            verdict="dropped",
            why=f"Placeholder: {missing}",
        )

    def document(self, title: str) -> Document:
        """Return a document with all elements, and the connections among them."""
        elements = [element for piece in self.pieces.values() for element in piece.elements]
        listed = [(element, (), 1) for element in elements + self.wiring.extra]
        doc, entries = edit.add_all(Document(title or self.tool), listed)
        by = {entry.element.name: entry for entry in entries}
        for source, port, target, entrance, reads in self.wiring.connections:
            doc = edit.connect(doc, by[source], port, by[target], entrance, reads)
        return doc

    def imported(
        self, doc: Document, name: str, dt: float, t0: float = 0.0, lines: Sequence[Line] = ()
    ) -> Imported:
        """Return the model of a document, with its report, in which further lines are the last."""
        report = ImportReport(self.tool, name, [*self.lines(), *lines], self.met)
        doc = edit.describe(doc, time_unit="ms", dt=dt, t0=t0, notes=report.text())
        return Imported(Model(document=doc), report)

    def lines(self) -> list[Line]:
        """Return all lines of the report."""
        return [*self.report, *self.wiring.lines]


def component_lines(e: Foreign, piece: Piece, components: Iterable[str]) -> list[Line]:
    """Report the ports of components, which scripts and plots of the tool read by name.

    Components with the same name in deodar are left out.
    """
    lines: list[Line] = []
    for component in components:
        outlet = piece.outlets.get(component)
        if outlet is None:
            where = piece.elsewhere.get(component, "")
            why = where or "no element here outputs it"
            lines.append(Line(e.label, "component", component, "carried" if where else "dropped", why))
        elif (outlet.name, outlet.port) != (e.label, component):
            why = f"read {display((outlet.name, outlet.port))}"
            lines.append(Line(e.label, "component", component, "carried", why))
    return lines
