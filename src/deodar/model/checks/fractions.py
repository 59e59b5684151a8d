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

Input = tuple[Node, str]
"""A node and one of its input ports."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check the readers of numbers between 0 and 1."""
    for n in wiring.declared:
        for port in n.element.bounded_inputs:
            for field, (first, first_port), alone in _fields(wiring, (n, port)):
                sentence = (
                    f"its port {port!r} needs numbers between 0 and 1, and reads {field.path}.output through"
                    f" {first.path}: means over cells leave that range at edges"
                )
                yield warning(n, sentence, _fix(wiring, field, first, first_port, alone))


def _fix(wiring: Wiring, field: Node, first: Node, port: str, alone: bool) -> str:
    connections = {
        c.source_port: c
        for c in wiring.doc.connections
        if (c.source, c.target, c.target_port) == (field.id, first.id, port)
    }
    if not alone or "output" not in connections or "bounded" in connections:
        return f"Connect {field.path}.bounded to it through a coupling of its own"
    ends = f"{field.path}.output", f"{first.path}.{quote(port)}"
    edit = SetSourcePort(*ends, f"{field.path}.bounded", connections["output"].reads)
    return EditFix("Read the bounded means", [edit])


def _fields(wiring: Wiring, reader: Input) -> Iterator[tuple[Node, Input, bool]]:
    """Yield the fields with cells whose output a port reads through couplings, each with the declared
    coupling that reads it, and whether nothing but the port reads the couplings.
    """
    couplings = {reader[0].id}
    fields: dict[tuple[str, str, str], tuple[Node, Input]] = {}
    ways = [(reader, reader)]  # an input, and the nearest one of a declared node
    seen = {(reader[0].id, reader[1])}
    while ways:
        (node, port), nearest = ways.pop()
        for source, out, _ in node.reads.get(port, ()):
            via = wiring.nodes[source]
            if isinstance(via.element, Field):
                if out == "output" and via.element.quadrature == "cell" and via.element.axes:
                    fields[source, nearest[0].id, nearest[1]] = via, nearest
                continue
            for inside in via.element.ports():
                if (source, inside) not in seen and _passes(via, inside, out):
                    seen.add((source, inside))
                    couplings.add(source)
                    ways.append(((via, inside), (via, inside) if via.declared else nearest))
    alone = all(wiring.readers[ident] <= couplings for ident in couplings - {reader[0].id})
    for field, first in fields.values():
        yield field, first, alone


def _passes(node: Node, port: str, out: str) -> bool:
    """Return whether an output is below 0 where an input is a little below 0, and not otherwise."""
    low = [
        node.element.bounds(node.ins, dict.fromkeys(node.element.ports(), SHARE) | {port: values}, {}).get(
            out, SHARE
        )[0]
        for values in (SHARE, BEYOND)
    ]
    return low[0] >= 0 > low[1]
