"""The graph of a document, made once: its nodes, their order in a step, and its problems."""

from __future__ import annotations

import dataclasses as dc
import weakref
from collections import deque
from collections.abc import Sequence

from deodar.errors import ModelError, Problem
from deodar.model.document import Document
from deodar.model.order import Act, order
from deodar.model.resolve import Node, resolve

KEPT = "_graph"
"""Key of the graph among the cached look-ups of a document."""

MOST_KEPT = 32
"""Number of documents that keep their graphs: a history of edits has many documents, and a graph needs about
1.5 KiB for each element.
"""

_latest: deque[weakref.ref[Document]] = deque()


@dc.dataclass(frozen=True)
class Graph:
    """The resolved graph of a document.

    Attributes:
        nodes: every node, implicit ones too.
        acts: all evaluations of a step in their order; empty if there are problems.
        problems: the problems that prevent every run.
    """

    nodes: Sequence[Node]
    acts: Sequence[Act]
    problems: Sequence[Problem]

    def required(self) -> Graph:
        """Return the graph; raise ModelError with all of its problems if there are any."""
        if self.problems:
            raise ModelError(self.problems)
        return self


def graph(doc: Document) -> Graph:
    """Return the graph of a document, which the document keeps."""
    found = doc.__dict__.get(KEPT)
    if found is None:
        found = doc.__dict__[KEPT] = _made(doc)
        _latest.append(weakref.ref(doc))
        while len(_latest) > MOST_KEPT:
            older = _latest.popleft()()
            if older is not None:
                older.__dict__.pop(KEPT, None)
    return found


def _made(doc: Document) -> Graph:
    nodes, problems = resolve(doc)
    if problems:
        return Graph(nodes, (), problems)
    acts, levels, loops = order(nodes)
    return Graph([dc.replace(n, level=levels[n.id]) for n in nodes], () if loops else acts, loops)
