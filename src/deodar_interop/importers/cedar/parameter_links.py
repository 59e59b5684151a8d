"""Parameter links: parameters that have the value of another one, as document parameters."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any

from deodar.errors import DeodarError
from deodar.importers.report import Line
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar_interop.importers.cedar.equation import solved
from deodar_interop.importers.cedar.file import CedarGroup, StepPath, members, text
from deodar_interop.importers.cedar.held import held
from deodar_interop.importers.cedar.values import number

STRUCTURE = ("dimensionality", "sizes", "number of")


def linked(doc: Document, root: CedarGroup, by: Mapping[StepPath, Entry]) -> tuple[Document, list[Line]]:
    """Return a document in which document parameters drive what is linked, and a line for each link."""
    lines: list[Line] = []
    for group in root.all_groups():
        for entry in group.links:
            doc, line = _link(doc, group, entry, by)
            lines.append(line)
    return doc, lines


def _link(
    doc: Document, group: CedarGroup, entry: Mapping[str, Any], by: Mapping[StepPath, Entry]
) -> tuple[Document, Line]:
    source, target = text(entry.get("source element")), text(entry.get("target element"))
    given, taken = text(entry.get("source parameter")), text(entry.get("target parameter"))
    where = ".".join((*group.path, *([target] if target else [])))
    what = f"{'.'.join(w for w in (source, given) if w)} -> {taken}"
    if any(taken.startswith(word) for word in STRUCTURE):
        return doc, Line(where, "parameter", what, "carried", "a link of sizes; they have the file's values")
    end = _end(group, target, taken, by)
    if end is None:
        return doc, Line(where, "parameter", what, "dropped", "the parameter has no counterpart here")
    first = _end(group, source, given, by) if source else None
    if source and first is None:
        return doc, Line(where, "parameter", what, "dropped", "its source has no counterpart here")
    value = number(group.values.get(given)) if first is None else first.value
    if value is None:
        return doc, Line(where, "parameter", what, "dropped", "its source holds no number")
    equation = text(members(entry.get("configuration")).get("equation"))
    direct = text(entry.get("type")).endswith("DirectParameterLink")
    result = value if direct else solved(equation, value)
    if result is None:
        why = f"the equation {equation!r} cannot be read; the parameter has the file's value"
        return doc, Line(where, "parameter", what, "dropped", why)
    same = direct or all(solved(equation, v) == v for v in (value, 0.0, 1.0, 2.0))
    try:
        if not same or (first is not None and first.sign != end.sign):
            new = edit.put(doc, end.ident, end.leaf, end.sign * result)
            why = f"as the value {result:g}; it does not follow when its source changes"
            return new, Line(where, "parameter", what, "approximated", why)
        ends = [e for e in (first, end) if e is not None]
        name = next((doc.links()[e.place] for e in ends if e.place in doc.links()), "")
        new = doc
        if not name:
            name = " ".join((*group.path, *([source] if source else []), given))
            new = edit.document_parameter(doc, name, end.sign * value)
        for e in ends:
            if e.place not in new.links():
                new = edit.link(new, *e.place, name)
    except DeodarError as error:
        return doc, Line(where, "parameter", what, "dropped", error.problems[0].what)
    return new, Line(where, "parameter", what, "carried", f"the document parameter {name!r}")


@dc.dataclass(frozen=True)
class LinkEnd:
    """One end of a link.

    Attributes:
        ident: id of the element.
        leaf: path of its parameter.
        sign: factor from cedar's number to deodar's.
        value: cedar's number.
    """

    ident: str
    leaf: str
    sign: float
    value: float

    @property
    def place(self) -> tuple[str, str]:
        """The element and its parameter."""
        return self.ident, self.leaf


def _end(group: CedarGroup, name: str, parameter: str, by: Mapping[StepPath, Entry]) -> LinkEnd | None:
    """Return one end of a link; None without a parameter of deodar that holds cedar's number."""
    entry, step = by.get((*group.path, name)), group.steps.get(name)
    found = None if entry is None or step is None else held(step, entry, parameter)
    if entry is None or found is None:
        return None
    return LinkEnd(entry.id, found.leaf, found.sign, found.value)
