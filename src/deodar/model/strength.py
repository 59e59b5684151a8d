"""The strength of a connection: the factor between the output that it reads and what arrives.

A plain connection has strength 1. Another strength is the factor of a `Gain` inside the connection, as
`u >> dd.Gain(3) >> v` in a script.
"""

from __future__ import annotations

from deodar import codec
from deodar.couplings.arithmetic import Gain
from deodar.element import Element
from deodar.model import edit, find
from deodar.model.building import EndPorts, connection
from deodar.model.document import Connection, Document, Entry
from deodar.model.sketch import is_coupling
from deodar.numerics.kernels._base import Kernel
from deodar.parameters import parameters

FACTOR = Gain.scaled_by


def set_strength(
    doc: Document, ends: EndPorts, strength: float, keeps: bool = False
) -> tuple[Document, str | None]:
    """Return a document in which a connection has another strength, and the id of its `Gain`, or None.

    A plain connection gets a `Gain`, which takes its place among the connections. At strength 1 the `Gain` is
    removed and the document is as it was before, unless the `Gain` is more than a number: it has a name of
    its own, a step of its own or other connections, a document parameter drives it, the layout refers to it
    (a plot, a pinned slider, a position), it belongs to a linked template, or the two elements are connected
    beside it.

    Args:
        doc: the document.
        ends: a plain connection, or the one into its `Gain`; an empty port means the default one.
        strength: the factor.
        keeps: keep the `Gain` at strength 1, while a person is still dragging.

    Raises:
        UnknownName: the document has no such connection.
        ParameterError: the strength is no finite number, or a document parameter drives the factor.
    """
    wire = connection(doc, ends)
    if gain_on_wire(doc, wire.target) is None:
        return (doc, None) if strength == 1 else _with_gain(doc, wire, strength)
    doc = edit.put(doc, wire.target, FACTOR, strength)
    if strength != 1 or keeps or not _is_only_number(doc, wire):
        return doc, wire.target
    out = next(c for c in doc.connections if c.source == wire.target)
    plain = Connection(wire.source, wire.source_port, out.target, out.target_port, wire.reads)
    return edit.remove(edit.replace_connections(doc, [wire, out], [plain]), [wire.target]), None


def gain_on_wire(doc: Document, ident: str) -> Entry | None:
    """Return the `Gain` of an id if it has one connection in and one out; else None."""
    entry = find.entry(doc, ident)
    into = sum(c.target == ident for c in doc.connections)
    out = sum(c.source == ident for c in doc.connections)
    return entry if type(entry.element) is Gain and into == out == 1 else None


def strength_path(element: Element) -> str:
    """Return the path of the number that is the strength of a coupling, such as `factor` or
    `kernel.0.amplitude`; empty if no single number is.
    """
    if not is_coupling(element):
        return ""
    kernels = element.kernels()
    if len(kernels) == 1 and _has_number(kernels[0], "amplitude"):
        return "kernel.0.amplitude" if getattr(element, "kernel", None) == (kernels[0],) else ""
    numbers = [name for name in element.signed_by if _has_number(element, name)]
    return numbers[0] if len(numbers) == len(element.signed_by) == 1 else ""


def _has_number(part: Element | Kernel, name: str) -> bool:
    return any(p.name == name and p.form == "number" for p in parameters(type(part)))


def _with_gain(doc: Document, wire: Connection, strength: float) -> tuple[Document, str]:
    """Return a document with a new `Gain` inside a connection, and its id."""
    doc, gain = edit.add(doc, Gain(strength), after=find.entry(doc, wire.source))
    halves = [
        Connection(wire.source, wire.source_port, gain.id, "input", wire.reads),
        Connection(gain.id, "output", wire.target, wire.target_port),
    ]
    return edit.replace_connections(doc, [wire], halves), gain.id


def _is_only_number(doc: Document, wire: Connection) -> bool:
    """Return whether the `Gain` that a connection leads to is nothing but the strength of this wire."""
    gain = find.entry(doc, wire.target)
    out = next(c for c in doc.connections if c.source == gain.id)
    unnamed = edit.is_unnamed(gain.names[-1], gain.element)
    alone = gain.every == 1 and not out.reads and (gain.id, FACTOR) not in doc.links()
    beside = (wire.source, wire.source_port, out.target, out.target_port) in doc.ends()
    used = any(gain.id == ident for use in doc.uses for _, ident in use.elements)
    return unnamed and alone and not beside and not used and gain.id not in codec.line(doc.layout)
