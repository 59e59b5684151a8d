"""The resolved graph of a document, as checks read it."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from deodar.model.document import Document
from deodar.model.resolve import Node


class Wiring:
    """A document, its resolved nodes, and who reads whom.

    Attributes:
        doc: the document.
        nodes: every node, implicit ones too, by id.
        declared: the nodes of the document's own elements, in their order.
    """

    def __init__(self, doc: Document, nodes: Sequence[Node]) -> None:
        self.doc = doc
        self.nodes = {n.id: n for n in nodes}
        self.declared = [self.nodes[e.id] for e in doc.entries if e.id in self.nodes]

    @functools.cached_property
    def readers(self) -> dict[str, set[str]]:
        """For each node the ids of the nodes that read one of its outputs."""
        found: dict[str, set[str]] = {i: set() for i in self.nodes}
        for n in self.nodes.values():
            for slots in n.reads.values():
                for source, _, _ in slots:
                    found[source].add(n.id)
        return found
