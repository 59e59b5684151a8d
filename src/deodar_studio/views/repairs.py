"""What a button of the page does about a problem: the edit that solves it, or what a person has to choose.

Every problem of an element or of a document parameter has a button, also one of a kind that a package adds:
the last resort is to remove what has the problem.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from deodar.errors import ConnectionFix, EditFix, Problem, WorldFix
from deodar.model import building, edit, proposed
from deodar.model.document import Document
from deodar_studio.messages.to_page import EndsView

Repair = tuple[str, Callable[[Document], Document]]
"""The words on a button, and the edit that it makes."""


class NamedPlaces:
    """What the `where` of a problem names in a document.

    Args:
        doc: the document.

    Attributes:
        ids: the id of each element by its path.
        parameters: the names of the document parameters.
    """

    def __init__(self, doc: Document) -> None:
        self.ids = {e.path: e.id for e in doc.entries}
        self.parameters = {p.name for p in doc.parameters}

    def element(self, where: str) -> str:
        """Return the id of the element that `u`, `u.tau` or `u (script.py:3)` names; "" if none.

        Names may contain dots and brackets, so the longest path that fits is the element; a document
        parameter with this name is no element.
        """
        if where in self.parameters:
            return ""
        ends = [k for k in range(len(where)) if where[k] == "." or where[k : k + 2] == " ("]
        paths = (where[:end] for end in [len(where), *reversed(ends)])
        return next((self.ids[path] for path in paths if path in self.ids), "")


def repair_of(doc: Document, problem: Problem, places: NamedPlaces | None = None) -> Repair | None:
    """Return the edit that solves a problem of a document; None for a problem of nothing in it."""
    fix, places = problem.fix, places or NamedPlaces(doc)
    if isinstance(fix, EditFix):
        words = fix.advice.rpartition(". ")[2]
        return words, functools.partial(proposed.apply, edits=fix.edits)
    wire = wire_of(problem, places)
    if wire is not None and wire.source and wire.target:
        ends = (wire.source, wire.source_port, wire.target, wire.target_port)
        return "Remove the connection", lambda document: edit.disconnect(document, *ends)
    if problem.where in places.parameters:
        return "Remove it", functools.partial(edit.remove_document_parameter, name=problem.where)
    if element := places.element(problem.where):
        return "Remove it", lambda document: building.remove(document, [element])
    return None


def button(doc: Document, problem: Problem, places: NamedPlaces) -> dict[str, Any]:
    """Return what a `ListedProblem` says about its button."""
    repair = repair_of(doc, problem, places)
    return {
        "repair": "" if repair is None else repair[0],
        "wire": wire_of(problem, places),
        "world": isinstance(problem.fix, WorldFix),
    }


def wire_of(problem: Problem, places: NamedPlaces) -> EndsView | None:
    """Return the connection of which the user chooses a part; an end to be chosen is empty."""
    if not isinstance(problem.fix, ConnectionFix):
        return None
    source, source_port, target, target_port = problem.fix.ends
    ends = [places.ids.get(path, "") for path in (source, target)]
    return EndsView(source=ends[0], source_port=source_port, target=ends[1], target_port=target_port)
