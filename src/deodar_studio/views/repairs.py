"""What a button of the page does about a problem: the edit that solves it, or what a person has to choose.

Every problem of an element or of a document parameter has a button, also one of a kind that a package adds:
the last resort is to remove what has the problem.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence

from deodar.errors import ConnectionFix, EditFix, Problem
from deodar.model import building, edit, proposed
from deodar.model.document import Document
from deodar_studio.messages.to_page import EndsView

PathIds = Mapping[str, Sequence[tuple[int, str]]]
"""The ids of the elements by their paths, each with its position in the document."""

Repair = tuple[str, Callable[[Document], Document]]
"""The words on a button, and the edit that it makes."""


def repair_of(doc: Document, problem: Problem, ids: PathIds | None = None) -> Repair | None:
    """Return the edit that solves a problem of a document; None for a problem of nothing in it."""
    fix, ids = problem.fix, ids_of(doc) if ids is None else ids
    if isinstance(fix, EditFix):
        words = fix.advice.rpartition(". ")[2]
        return words, functools.partial(proposed.apply, edits=fix.edits)
    wire = wire_of(problem, ids)
    if wire is not None and wire.source and wire.target:
        ends = (wire.source, wire.source_port, wire.target, wire.target_port)
        return "Remove the connection", lambda document: edit.disconnect(document, *ends)
    if elements := concerned(problem.where, ids):
        return "Remove it", lambda document: building.remove(document, elements)
    if problem.where in [p.name for p in doc.parameters]:
        return "Remove it", functools.partial(edit.remove_document_parameter, name=problem.where)
    return None


def wire_of(problem: Problem, ids: PathIds) -> EndsView | None:
    """Return the connection of which the user chooses a part; an end to be chosen is empty."""
    if not isinstance(problem.fix, ConnectionFix):
        return None
    source, source_port, target, target_port = problem.fix.ends
    ends = [ids[path][0][1] if path in ids else "" for path in (source, target)]
    return EndsView(source=ends[0], source_port=source_port, target=ends[1], target_port=target_port)


def ids_of(doc: Document) -> PathIds:
    """Return the ids of the elements by their paths."""
    ids: dict[str, list[tuple[int, str]]] = {}
    for k, e in enumerate(doc.entries):
        ids.setdefault(e.path, []).append((k, e.id))
    return ids


def concerned(where: str, ids: PathIds) -> list[str]:
    """Return the elements that the `where` of a problem names: `u`, `u.tau` or `u (script.py:3)`."""
    ends = [k for k in range(len(where)) if where[k] == "." or where[k : k + 2] == " ("]
    return [i for _, i in sorted(named for end in [*ends, len(where)] for named in ids.get(where[:end], ()))]
