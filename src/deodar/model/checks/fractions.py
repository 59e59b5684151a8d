"""Ports that need numbers between 0 and 1, and read means over cells through couplings.

Such a port reads the port `bounded` of a field that it is connected to. Through a coupling it reads what the
coupling makes of `output`, which leaves that range at edges.
"""

from __future__ import annotations

from collections.abc import Iterator

from deodar.elements.field import Field
from deodar.errors import EditFix, Problem
from deodar.model.paths import quote
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.proposed_edit import SetSourcePort

SHARE, BEYOND = (0.0, 1.0), (-0.1, 1.1)
"""The range of an output function, and that of its means over cells."""

Way = tuple[tuple[Node, str], ...]
"""Nodes from a field to a reader, each with the port that the next one reads, or its own input port."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check the readers of numbers between 0 and 1."""
    for n in wiring.declared:
        for port in n.element.bounded_inputs:
            for field, first, first_port, alone in _fields(wiring, n, port, frozenset()):
                sentence = (
                    f"its port {port!r} needs numbers between 0 and 1, and reads {field.path}.output through"
                    f" {first.path}: means over cells leave that range at edges"
                )
                source = f"{field.path}.output"
                edit = SetSourcePort(source, f"{first.path}.{quote(first_port)}", f"{field.path}.bounded")
                text = f"Connect {field.path}.bounded to it through a coupling of its own"
                yield warning(n, sentence, EditFix("Read the bounded means", [edit]) if alone else text)


def _fields(
    wiring: Wiring, n: Node, port: str, passed: frozenset[str]
) -> Iterator[tuple[Node, Node, str, bool]]:
    """Yield the fields with cells that a port reads through couplings, each with the declared coupling that
    reads it, its port, and whether nothing else reads the couplings.
    """
    for source, out, _ in n.reads.get(port, ()):
        via = wiring.nodes[source]
        if source in passed or isinstance(via.element, Field):
            continue
        for inside in via.element.ports():
            if not _passes(via, inside, out):
                continue
            alone = wiring.readers[source] == {n.id}
            for origin, origin_port, _ in via.reads.get(inside, ()):
                field = wiring.nodes[origin]
                cells = isinstance(field.element, Field) and field.element.quadrature == "cell"
                if cells and origin_port == "output" and via.declared:
                    yield field, via, inside, alone
            for field, first, first_port, others in _fields(wiring, via, inside, passed | {source}):
                yield field, first, first_port, others and alone


def _passes(node: Node, port: str, out: str) -> bool:
    """Return whether an output is below 0 where an input is a little below 0, and not otherwise."""
    low = [
        node.element.bounds(node.ins, {p: SHARE for p in node.element.ports()} | {port: values}, {}).get(
            out, SHARE
        )[0]
        for values in (SHARE, BEYOND)
    ]
    return low[0] >= 0 > low[1]
