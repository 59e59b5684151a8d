"""The strength of a connection: the factor between the output that it reads and what arrives.

A plain connection has strength 1. Another strength is the factor of a `Gain` inside the connection, as
`u >> dd.Gain(3) >> v` in a script.
"""

from __future__ import annotations

import dataclasses as dc

from deodar import codec
from deodar.couplings.arithmetic import Gain
from deodar.element import Element
from deodar.errors import ModelError
from deodar.model import edit, find
from deodar.model.building import EndPorts, connection
from deodar.model.document import Connection, Document, Entry
from deodar.model.paths import display
from deodar.model.sketch import is_coupling
from deodar.model.stated_ports import (
    layout_without_ports,
    stated_ports,
    with_stated_ports,
    without_stated_ports,
)
from deodar.numerics.kernels._base import Kernel
from deodar.parameters import parameters

FACTOR = Gain.scaled_by


def set_strength(
    doc: Document, ends: EndPorts, strength: float, keeps: bool = False
) -> tuple[Document, str | None]:
    """Return a document in which a connection has another strength, and the id of its `Gain`, or None.

    A connection without a `Gain` gets one, which takes its place among the connections. Behind a coupling
    with several kernels or with weights it scales all of them together. At strength 1 the `Gain` is removed
    and the document is as it was before, unless the `Gain` is more than a number: it has a name of
    its own, which does not end in `>Gain`, lies in another group than its source, has a step of its own or
    other connections, a document parameter drives it, the layout refers to it (a plot, a pinned slider, a
    position), it belongs to a linked template, or the two elements are connected beside it.

    Where the target needs numbers between 0 and 1 (`bounded_inputs`), the `Gain` reads the `bounded_port` of
    the source, as the target does without it. If the connection states that port itself, the layout has it
    (`stated_ports`), and the connection states it again at strength 1.

    Args:
        doc: the document.
        ends: a plain connection, or the one into its `Gain`; an empty port means the default one.
        strength: the factor.
        keeps: keep the `Gain` at strength 1, and its input port, while a person is still dragging.

    Raises:
        UnknownName: the document has no such connection.
        ModelError: the plain connection belongs to a linked group, whose template has its strength.
        ParameterError: the strength is no finite number, or a document parameter drives the factor.
    """
    wire = _wire(doc, ends)
    gain = gain_on_wire(doc, wire.target)
    if gain is None and strength == 1:
        return doc, None
    doc, ident = (
        _with_gain(doc, wire, strength)
        if gain is None
        else (edit.put(doc, gain.id, FACTOR, strength), gain.id)
    )
    if keeps:
        return doc, ident
    plain = _plain(doc, ident) if strength == 1 else None
    if plain is None:
        return _bounded(doc, ident), ident
    doc = edit.remove(edit.replace_connections(doc, _halves(doc, ident), [plain]), [ident])
    return without_stated_ports(doc, [ident]), None


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


def _wire(doc: Document, ends: EndPorts) -> Connection:
    """Return the connection between two ports.

    Either port of those that `bounded_port` relates stands for the other one, unless both are connected: a
    connection reads the one with a `Gain` and the other without.
    """
    source, target = find.entry(doc, ends[0]), find.entry(doc, ends[2])
    ports, bounded = find.outputs(source), source.element.bounded_port
    stated = ends[1] or next(iter(ports), "")
    into = ends[3] or next(iter(target.element.ports()), "")
    if (source.id, stated, target.id, into) not in doc.ends():
        for port in ports:
            if bounded(port) == bounded(stated) and (source.id, port, target.id, into) in doc.ends():
                return connection(doc, (source.id, port, target.id, into))
    return connection(doc, ends)


def _halves(doc: Document, gain: str) -> tuple[Connection, Connection]:
    """Return the connection into a `Gain` on a wire, and the one out of it."""
    into = next(c for c in doc.connections if c.target == gain)
    return into, next(c for c in doc.connections if c.source == gain)


def _with_gain(doc: Document, wire: Connection, strength: float) -> tuple[Document, str]:
    """Return a document with a new `Gain` inside a connection, and its id."""
    for use in doc.uses:
        if {wire.source, wire.target} <= {ident for _, ident in use.elements}:
            group = display(use.group)
            raise ModelError(
                f"the connection belongs to the group {group!r}, which is linked to the template"
                f" {use.template!r}",
                where=f"{find.entry(doc, wire.source).path} -> {find.entry(doc, wire.target).path}",
                fix="Change its strength in the template, and refresh the group",
            )
    doc, gain = edit.add(doc, Gain(strength), after=find.entry(doc, wire.source))
    halves = [
        Connection(wire.source, wire.source_port, gain.id, "input", wire.reads),
        Connection(gain.id, "output", wire.target, wire.target_port),
    ]
    doc = without_stated_ports(doc, [gain.id])  # of an earlier Gain, which had the same id
    if wire.source_port != _stated_by(doc, wire)[0]:
        doc = with_stated_ports(doc, {**stated_ports(doc), gain.id: wire.source_port})
    return edit.replace_connections(doc, [wire], halves), gain.id


def _stated_by(doc: Document, wire: Connection) -> list[str]:
    """Return the ports that a connection may state for what it reads, the usual one first."""
    source = find.entry(doc, wire.source)
    bounded = source.element.bounded_port
    if not _needs_bounded(doc, wire):
        return [wire.source_port]
    ports = [p for p in find.outputs(source) if bounded(p) == bounded(wire.source_port)]
    return sorted(ports, key=lambda p: p == bounded(p))


def _bounded(doc: Document, ident: str) -> Document:
    """Return a document in which an unnamed `Gain` reads what its target would read without it.

    Ports of `bounded_inputs` read the `bounded_port` of an element that they are connected to, and of no
    element behind a coupling.
    """
    gain = find.entry(doc, ident)
    into, out = _halves(doc, ident)
    port = find.entry(doc, into.source).element.bounded_port(into.source_port)
    if not edit.is_unnamed(gain.names[-1], gain.element) or not _needs_bounded(doc, out):
        return doc
    return doc if port == into.source_port else edit.set_source_port(doc, into.ends, port)


def _needs_bounded(doc: Document, wire: Connection) -> bool:
    return wire.target_port in find.entry(doc, wire.target).element.bounded_inputs


def _plain(doc: Document, ident: str) -> Connection | None:
    """Return the connection without its `Gain`; None if the `Gain` is more than the strength of this wire."""
    gain = find.entry(doc, ident)
    into, out = _halves(doc, ident)
    source = find.entry(doc, into.source)
    unnamed = edit.is_unnamed(gain.names[-1], gain.element) and gain.group == source.group
    alone = gain.every == 1 and not out.reads and (gain.id, FACTOR) not in doc.links()
    used = any(gain.id == i for use in doc.uses for _, i in use.elements)
    if not unnamed or not alone or used or gain.id in codec.line(layout_without_ports(doc)):
        return None
    stated = stated_ports(doc).get(gain.id)
    # a plain connection states the port that has values beyond the range too
    ports = sorted(
        _stated_by(doc, dc.replace(into, target=out.target, target_port=out.target_port)),
        key=lambda port: port != stated,
    )
    plain = [Connection(into.source, p, out.target, out.target_port, into.reads) for p in ports]
    return next((c for c in plain if c.ends not in doc.ends()), None)
