"""The resolved graph of a document, for the checks."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from deodar.errors import Problem
from deodar.model.document import Document
from deodar.model.resolve import Node, reach, readers
from deodar.numerics.intervals import ANY, ZERO, Interval, total

MOST_PASSES = 200
"""Number of passes over the graph after which bounds that still widen count as unknown."""


class Wiring:
    """A document, its resolved nodes, their readers, and the bounds of their signals.

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
        """For each node, the ids of the nodes that read one of its outputs."""
        return readers(self.nodes.values())

    def sources(self, node: Node, port: str = "input") -> list[Node]:
        """Return the document's own elements that a port reads, through implicit projections and delays."""
        sources: list[Node] = []
        for source, _, _ in node.reads.get(port, ()):
            n = self.nodes[source]
            sources += [n] if n.declared else self.sources(n)
        return sources

    @functools.cached_property
    def driven(self) -> set[str]:
        """The ids of the nodes that external signals can reach: elements without inputs, such as stimuli and
        sensors, and all nodes that they reach.

        Without any, the model is a template, which gets its inputs where it is used.
        """
        return reach((n.id for n in self.declared if not n.element.ports()), self.readers.__getitem__)

    @functools.cached_property
    def position(self) -> dict[str, int]:
        """The position of each declared element in the document, by id."""
        return {n.id: k for k, n in enumerate(self.declared)}

    def arriving(self, node: Node) -> Interval:
        """Return bounds of the sum that arrives at the port `input`."""
        return total(*(self.bounds[i].get(p, ANY) for i, p, _ in node.reads.get("input", ())))

    @functools.cached_property
    def bounds(self) -> dict[str, dict[str, Interval]]:
        """For each node the bounds of its ports: the smallest intervals found that hold all values reachable
        from the initial values.
        """
        intervals: dict[str, dict[str, Interval] | None] = dict.fromkeys(self.nodes)
        growing: set[str] = set(self.nodes)
        for k in range(MOST_PASSES):
            moved: set[str] = set()
            for i in growing:
                n = self.nodes[i]
                inputs = {
                    port: total(*(_known(intervals, source, p) for source, p, _ in slots))
                    for port, slots in n.reads.items()
                }
                before = intervals[i]
                intervals[i] = new = dict(n.element.bounds(n.ins, inputs, before or {}))
                if before is None or any(_apart(v, before.get(port, ANY)) for port, v in new.items()):
                    moved.add(i)
            if not moved:
                break
            if k >= MOST_PASSES // 2:  # values that still widen have no bounds
                growing -= moved
                intervals |= {i: {} for i in moved}
        return {i: values or {} for i, values in intervals.items()}


def warning(node: Node, sentence: str, fix: str) -> Problem:
    """Return a warning about one element."""
    return Problem(node.path, sentence, fix, "warning")


def _known(intervals: dict[str, dict[str, Interval] | None], source: str, port: str) -> Interval:
    """Return the bounds of an output: empty for a node not yet visited, unbounded for a node that states
    none.
    """
    values = intervals[source]
    return ZERO if values is None else values.get(port, ANY)


def _apart(a: Interval, b: Interval) -> bool:
    return any(x != y and abs(x - y) > 1e-6 for x, y in zip(a, b, strict=True))
