"""Collect all problems of a document, each with its path."""

from __future__ import annotations

from collections.abc import Sequence

from deodar.errors import KindError, Problem
from deodar.model import kind_contract
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.kind_contract import errors_in
from deodar.model.proposed import CheckedDocument, bound, proven
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring
from deodar.registry import imported


def check(doc: Document) -> list[Problem]:
    """Return all problems of the structure; without any, those of the classes of users' kinds, the warnings,
    and the problems of the document's own step.
    """
    if structural := problems(doc):
        return proven(doc, structural)
    nodes = graph(doc).nodes
    try:
        with errors_in(doc):
            of_kinds = list(kind_contract.broken(nodes))
            return [*of_kinds, *judge(doc, nodes)]
    except KindError as error:
        return list(error.problems)


def problems(doc: Document) -> list[Problem]:
    """Return the problems that prevent every run at any step, without warnings. An empty list: it
    compiles.
    """
    return list(graph(doc).problems)


def judge(doc: Document, nodes: Sequence[Node]) -> list[Problem]:
    """Return the warnings of each element and of each file of `checks`, in the order of the elements."""
    wiring = Wiring(doc, nodes)
    warnings = [
        Problem(n.path, sentence, fix, "warning")
        for n in wiring.declared
        for sentence, fix in n.element.warnings(n.ins)
    ]
    for family in imported("deodar.model.checks"):
        warnings += family.check(wiring)
    place = {e.path: k for k, e in enumerate(doc.entries)}
    checked = CheckedDocument(doc)
    bound_warnings = dict.fromkeys(bound(checked, w) for w in warnings)
    return sorted(bound_warnings, key=lambda p: (p.severity, place.get(p.where, len(place))))
