r"""The import report in a document: a key of its layout, so that it is in the saved file too.

    "import_report": {
      "tool": "cedar", "file": "memory.json", "bugs": [],
      "items": [{"where": "field", "element": "4aa63678", "lines": [
        "carried element cedar.dynamics.NeuralField\nField",
        "approximated parameter sigmoid.beta\nit is \"x\"; 100 is used"]}]}

An item has the lines of one label of the imported file, and the id of the element with that label, which
stays the same when the element is renamed or moved; `element` is absent if the model has no such element. A
line has the words verdict and part, the name, and, after a line break, the reason.
"""

from __future__ import annotations

import dataclasses as dc

import msgspec

from deodar.codec import JsonObject
from deodar.importers.report import VERDICTS, ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document

KEY = "import_report"
"""Key of the layout for the report."""


class StoredItem(msgspec.Struct):
    """The lines of one label of the file, and the id of its element; empty: the model has none."""

    lines: list[str]
    where: str = ""
    element: str = ""


class StoredReport(msgspec.Struct):
    """A report as the layout has it."""

    tool: str
    file: str
    items: list[StoredItem]
    bugs: list[str] = []


def located(report: ImportReport, doc: Document) -> ImportReport:
    """Return a report whose lines have the ids of the elements of a document that they are about.

    A line is about the element whose path is the line's label. Call it before elements are renamed.
    """
    ids = {".".join(entry.names): entry.id for entry in doc.entries}
    return dc.replace(
        report, lines=[dc.replace(line, element=ids.get(line.where, "")) for line in report.lines]
    )


def with_report(doc: Document, report: ImportReport) -> Document:
    """Return a document that contains the report of its import."""
    items: dict[str, tuple[str, list[str]]] = {}
    for line in located(report, doc).lines:
        items.setdefault(line.where, (line.element, []))[1].append(_text(line))
    data: JsonObject = {
        "tool": report.tool,
        "file": report.file,
        "bugs": list(report.bugs),
        "items": [_item(where, element, lines) for where, (element, lines) in items.items()],
    }
    return edit.arrange(doc, {**doc.layout, KEY: data})


def without_report(doc: Document) -> Document:
    """Return a document that does not contain a report."""
    if KEY not in doc.layout:
        return doc
    return edit.arrange(doc, {key: value for key, value in doc.layout.items() if key != KEY})


def report_of(doc: Document) -> ImportReport | None:
    """Return the report that a document contains; None without one, and for anything else under its key.

    The lines of a label follow each other.
    """
    if KEY not in doc.layout:
        return None
    try:
        found = msgspec.convert(doc.layout[KEY], StoredReport)
        lines = [_line(item, text) for item in found.items for text in item.lines]
    except (ValueError, RecursionError):
        return None
    return ImportReport(found.tool, found.file, lines, found.bugs)


def _item(where: str, element: str, lines: list[str]) -> JsonObject:
    named: JsonObject = {"where": where} if where else {}
    return {**named, **({"element": element} if element else {}), "lines": list(lines)}


def _text(line: Line) -> str:
    what = line.what.replace("\n", " ")
    return f"{line.verdict} {line.part} {what}" + (f"\n{line.why}" if line.why else "")


def _line(item: StoredItem, text: str) -> Line:
    """Return the line that a text states; ValueError if it states none."""
    verdict, part, rest = text.split(" ", 2)
    if verdict not in VERDICTS:
        raise ValueError(f"{verdict!r} is not a verdict")
    what, _, why = rest.partition("\n")
    return Line(item.where, part, what, verdict, why, item.element)
