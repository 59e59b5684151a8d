"""The document of an imported file: its elements, and its connections by the names of the elements."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.element import Element
from deodar.model import edit
from deodar.model.document import Document
from deodar_interop.importers._wiring import SourceWire


def assembled(doc: Document, elements: Iterable[Element], connections: Iterable[SourceWire]) -> Document:
    """Return a document with elements of different names, and connections among them."""
    doc, entries = edit.add_all(doc, [(element, (), 1) for element in elements])
    by = {entry.element.name: entry for entry in entries}
    for source, port, target, entrance, reads in connections:
        doc = edit.connect(doc, by[source], port, by[target], entrance, reads)
    return doc
