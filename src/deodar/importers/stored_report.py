r"""The import report in a document: a key of its layout, so that it is in the saved file too.

    "import_report": {
      "tool": "cedar", "file": "memory.json", "bugs": [],
      "items": [{"where": "field", "element": "4aa63678", "lines": [
        "carried element cedar.dynamics.NeuralField\nField",
        "approximated parameter sigmoid.beta\nit is \"x\"; 100 is used"]}]}

An item has the lines of one label of the imported file, and the id of the element with that label, which
stays the same when the element is renamed or moved; `element` is absent if the model has no such element. An
item of a group has the names of the group, `"group": ["outer", "inner"]`, and the id of the first element in
it, because groups have no ids. A line has the words verdict and part, the name, and, after a line break, the
reason.
"""

from __future__ import annotations

import dataclasses as dc

import msgspec

from deodar.codec import JsonObject
from deodar.importers.report import VERDICTS, ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.paths import PathNames

KEY = "import_report"
"""Key of the layout for the report."""


class StoredItem(msgspec.Struct):
    """The lines of one label of the file, the id of its element, and the names of its group; empty: none."""

    lines: list[str]
    where: str = ""
    element: str = ""
    group: list[str] = []


class StoredReport(msgspec.Struct):
    """A report as the layout has it."""

    tool: str
    file: str
    items: list[StoredItem]
    bugs: list[str] = []


def located(report: ImportReport, doc: Document) -> ImportReport:
    """Return a report whose lines have the ids of the elements of a document that they are about.

    A line is about the element, or else the group, whose path is the line's label. Call it before elements
    are renamed.
    """
    found: dict[str, tuple[str, PathNames]] = {".".join(group): ("", group) for group in doc.groups}
    for entry in doc.entries:
        for k in range(1, len(entry.names)):
            label = ".".join(entry.names[:k])
            if not found.get(label, ("", ()))[0]:
                found[label] = (entry.id, entry.names[:k])
    found |= {".".join(entry.names): (entry.id, ()) for entry in doc.entries}
    lines: list[Line] = []
    for line in report.lines:
        element, group = found.get(line.where, ("", ()))
        lines.append(dc.replace(line, element=element, group=group))
    return dc.replace(report, lines=lines)


def with_report(doc: Document, report: ImportReport) -> Document:
    """Return a document that contains the report of its import."""
    items: dict[str, list[Line]] = {}
    for line in located(report, doc).lines:
        items.setdefault(line.where, []).append(line)
    data: JsonObject = {
        "tool": report.tool,
        "file": report.file,
        "bugs": list(report.bugs),
        "items": [_item(lines) for lines in items.values()],
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


def _item(lines: list[Line]) -> JsonObject:
    first = lines[0]
    named = {"where": first.where, "element": first.element, "group": list(first.group)}
    return {**{key: value for key, value in named.items() if value}, "lines": [_text(line) for line in lines]}


def _text(line: Line) -> str:
    what = line.what.replace("\n", " ")
    return f"{line.verdict} {line.part} {what}" + (f"\n{line.why}" if line.why else "")


def _line(item: StoredItem, text: str) -> Line:
    """Return the line that a text states; ValueError if it states none."""
    verdict, part, rest = text.split(" ", 2)
    if verdict not in VERDICTS:
        raise ValueError(f"{verdict!r} is not a verdict")
    what, _, why = rest.partition("\n")
    return Line(item.where, part, what, verdict, why, item.element, tuple(item.group))
