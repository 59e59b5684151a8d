"""A document as parts of messages, and what an edit changes of them.

What did not change between two versions is converted once: an edit costs what it changes.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import Any

from deodar.element import Element
from deodar.errors import Problem
from deodar.model import document_files, find, proposed
from deodar.model.document import Document, Entry
from deodar.model.document_graph import graph
from deodar.model.parts import to_json
from deodar.model.resolve import Node
from deodar.model.sketch import effect
from deodar.model.strength import strength_path
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import FrozenArray
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import (
    AxisView,
    ConnectionView,
    DocumentParameterView,
    ElementView,
    KeyedDifference,
    LayoutView,
    LinkView,
)
from deodar_studio.views import layouts
from deodar_studio.views.difference import difference

MOST_RESOLVED = 2000
"""About the largest number of elements that are resolved in order to try the repairs of one document."""

Ports = Mapping[str, Axes]


@dc.dataclass(frozen=True)
class Converted:
    """A document as parts of messages.

    Attributes:
        document: the document.
        axes: its axes by their keys.
        arrays: its arrays by their keys.
        ports: axes of the ports of each element, by id.
        elements: its elements as sent to the page, in their order, by id.
        connections: its connections as sent to the page.
        layout: its layout as sent to the page.
        problems: problems of its structure, without warnings; those with edits are solved by them.
        nodes: its resolved nodes, for the warnings.
        warnings: its warnings in the present world.
    """

    document: Document
    axes: Mapping[str, Axis]
    arrays: Mapping[str, FrozenArray]
    ports: Mapping[str, Ports]
    elements: Mapping[str, ElementView]
    connections: list[ConnectionView]
    layout: LayoutView
    problems: Sequence[Problem]
    nodes: Sequence[Node]
    warnings: Sequence[Problem] = ()


def convert(doc: Document, before: Converted | None = None) -> Converted:
    """Convert a document; elements that `before` has already are taken from there."""
    if before is not None and before.document.layout is doc.layout:
        layout = before.layout
    else:
        layout = layouts.layout(doc)
    if before is not None and _same_model(before.document, doc):
        return dc.replace(before, document=doc, layout=layout)
    resolved = graph(doc)
    axes, arrays = document_files.axes(doc), document_files.arrays(doc)
    found = {n.id: n for n in resolved.nodes if n.declared}
    ports: dict[str, Ports] = {e.id: _ports(found.get(e.id)) for e in doc.entries}
    old: Mapping[str, Entry] = {}
    if before is not None and _same_axes(before.axes, axes) and _same_arrays(before.arrays, arrays):
        old = before.document.by_id()
    named = {axis: key for key, axis in axes.items()}
    elements: dict[str, ElementView] = {}
    for e in doc.entries:
        if before is not None and old.get(e.id) is e and before.ports[e.id] == ports[e.id]:
            elements[e.id] = before.elements[e.id]
        else:
            elements[e.id] = _element(e, ports[e.id], named, arrays)
    wires = doc.connections
    if before is not None and before.document.connections is wires:
        connections = before.connections
    else:
        connections = [made_of(ConnectionView, wire) for wire in wires]
    most = min(proposed.MOST_TRIED, 1 + MOST_RESOLVED // (1 + len(doc.entries)))
    problems = proposed.proven(doc, resolved.problems, most)
    return Converted(doc, axes, arrays, ports, elements, connections, layout, problems, resolved.nodes)


def _same_model(old: Document, new: Document) -> bool:
    """Return whether two documents share all that is converted: they differ in layout, names or notes."""
    same = old.entries is new.entries and old.connections is new.connections
    return same and old.spare_axes == new.spare_axes


def axes(converted: Converted) -> list[AxisView]:
    """Return the axes of a document for the page."""
    return [axis(a, key) for key, a in converted.axes.items()]


def axis(a: Axis, key: str = "") -> AxisView:
    """Convert an axis; `key` is its key in the document, empty if it has none."""
    return made_of(AxisView, a, key=key)


def parameters(doc: Document) -> list[DocumentParameterView]:
    """Convert the document parameters."""
    return [
        made_of(DocumentParameterView, k, links=[LinkView(element=i, parameter=p) for i, p in k.links])
        for k in doc.parameters
    ]


def parts(converted: Converted) -> dict[str, Any]:
    """Return the fields of a `DocumentView` that follow from the document alone."""
    doc = converted.document
    return {
        "title": doc.name,
        "time_unit": doc.time_unit,
        "dt": doc.dt,
        "notes": doc.notes,
        "axes": axes(converted),
        "elements": list(converted.elements.values()),
        "connections": converted.connections,
        "groups": [list(g) for g in doc.groups],
        "parameters": parameters(doc),
        "layout": converted.layout,
    }


def changes(before: Converted, after: Converted) -> KeyedDifference | None:
    """Return the difference of two documents; None if pages need the whole document."""
    if not (_same_axes(before.axes, after.axes) and _same_arrays(before.arrays, after.arrays)):
        return None
    return difference(parts(before), parts(after))


def _same_axes(old: Mapping[str, Axis], new: Mapping[str, Axis]) -> bool:
    """Return whether every axis that both tables have has the same key."""
    keys = {v: k for k, v in old.items()}
    return all(keys.get(v, k) == k for k, v in new.items())


def _same_arrays(old: Mapping[str, FrozenArray], new: Mapping[str, FrozenArray]) -> bool:
    """Return whether every array object that both tables have has the same key."""
    keys = {id(v): k for k, v in old.items()}
    return all(keys.get(id(v), k) == k for k, v in new.items())


def _ports(node: Node | None) -> Ports:
    return {} if node is None else {**node.ins, **node.outs}


def _element(
    e: Entry, ports: Ports, named: Mapping[Axis, str], arrays: Mapping[str, FrozenArray]
) -> ElementView:
    return ElementView(
        id=e.id,
        path=e.path,
        name=e.names[-1],
        group=list(e.group),
        kind=type(e.element).__name__,
        every=e.every,
        values=values(e.element, named, arrays),
        inputs=list(e.element.ports()),
        outputs=find.outputs(e),
        axes={port: [named.get(a, a.name) for a in found] for port, found in ports.items()},
        pushable=e.every == 1 and type(e.element).inject is not Element.inject,
        kernel=e.element.convolution is not None and len(e.element.kernels()) > 0,
        effect=effect(e.element),
        strength=strength_path(e.element),
    )


def values(element: Element, named: Mapping[Axis, str], arrays: Mapping[str, FrozenArray]) -> dict[str, Any]:
    """Return the parameters of an element, with the shape and the range of every array.

    Args:
        element: the element.
        named: keys of the document's axes.
        arrays: the document's arrays by their keys.
    """

    def array_key(array: FrozenArray) -> str:
        same = next((k for k, v in arrays.items() if v is array), None)
        return next(k for k, v in arrays.items() if v == array) if same is None else same

    plain = to_json(element, named.__getitem__, array_key)
    del plain["kind"]
    return _with_ranges(plain, arrays)


def _with_ranges(value: Any, arrays: Mapping[str, FrozenArray]) -> Any:
    """Return a value with the shape and the range of every array that it refers to."""
    if isinstance(value, list):
        return [_with_ranges(v, arrays) for v in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"array"} and value["array"] in arrays:
        content = arrays[value["array"]].data
        return value | {
            "shape": list(content.shape),
            "min": float(content.min()),
            "max": float(content.max()),
        }
    return {key: _with_ranges(v, arrays) for key, v in value.items()}
