"""The graph of a document, made once: its nodes, their order in a step, and its problems."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.errors import ModelError, Problem
from deodar.model.document import Document
from deodar.model.order import Act, order
from deodar.model.resolve import Node, resolve


@dc.dataclass(frozen=True)
class DocumentGraph:
    """The resolved graph of a document.

    Attributes:
        nodes: every node, implicit ones too.
        acts: all evaluations of a step in their order; empty if there are problems.
        problems: the problems that prevent every run.
    """

    nodes: Sequence[Node]
    acts: Sequence[Act]
    problems: Sequence[Problem]

    def required(self) -> DocumentGraph:
        """Return the graph; raise ModelError with all of its problems if there are any."""
        if self.problems:
            raise ModelError(self.problems)
        return self


def graph(doc: Document) -> DocumentGraph:
    """Return the graph of a document, which the document keeps."""
    resolved = doc.__dict__.get("_graph")
    if resolved is None:  # another thread may make it, or let the document forget it
        resolved = doc.__dict__["_graph"] = _resolved(doc)
    return resolved


def _resolved(doc: Document) -> DocumentGraph:
    nodes, problems = resolve(doc)
    if problems:
        return DocumentGraph(nodes, (), problems)
    acts, levels, loops = order(nodes)
    return DocumentGraph([dc.replace(n, level=levels[n.id]) for n in nodes], () if loops else acts, loops)
