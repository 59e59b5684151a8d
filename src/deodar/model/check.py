"""Everything that is wrong with a document, at once, each with its path."""

from __future__ import annotations

from deodar.errors import Problem
from deodar.model.document import Document
from deodar.model.order import order
from deodar.model.resolve import resolve


def check(doc: Document) -> list[Problem]:
    """All problems; none means that it compiles."""
    nodes, problems = resolve(doc)
    if not problems:
        problems = order(nodes)[1]
    return problems
