"""A document as parts of messages, and the difference of two documents as a patch.

What did not change between two versions is converted once: an edit costs what it changes.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from typing import Any, TypeVar

import msgspec

from deodar.declarations import Cost
from deodar.element import Element
from deodar.errors import Problem
from deodar.importers import stored_report
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
    Edited,
    ElementView,
    EndsView,
    GeneralView,
    LinkView,
    PathView,
    PlacedConnection,
)

MOST_RESOLVED = 2000
"""About the largest number of elements that are resolved in order to try the repairs of one document."""

H = TypeVar("H", bound=Hashable)
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
        problems: problems of its structure, without warnings; those with edits are solved by them.
        nodes: its resolved nodes, for the warnings.
        warnings: its warnings in the present world.
    """

    document: Document
    axes: Mapping[str, Axis]
    arrays: Mapping[str, FrozenArray]
    ports: Mapping[str, Ports]
    elements: Mapping[str, ElementView]
    problems: Sequence[Problem]
    nodes: Sequence[Node]
    warnings: Sequence[Problem] = ()


def convert(doc: Document, before: Converted | None = None) -> Converted:
    """Convert a document; elements that `before` has already are taken from there."""
    if before is not None and _same_model(before.document, doc):
        return dc.replace(before, document=doc)
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
    most = min(proposed.MOST_TRIED, 1 + MOST_RESOLVED // (1 + len(doc.entries)))
    problems = proposed.proven(doc, resolved.problems, most)
    return Converted(doc, axes, arrays, ports, elements, problems, resolved.nodes)


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


@dc.dataclass(frozen=True)
class Status:
    """What a patch states besides the document: as in `DocumentView`."""

    version: int
    unsaved: bool
    undo: int
    redo: int
    cost: Cost


def patch(
    before: Converted, after: Converted, status: Status, problems: Callable[[], Sequence[Any]]
) -> Edited | None:
    """Return the difference of two documents; None if the page needs the whole document.

    Args:
        before: the document that the page has.
        after: the document that it needs.
        status: numbers of the message.
        problems: converts the problems of the structure of `after`.
    """
    if not (_same_axes(before.axes, after.axes) and _same_arrays(before.arrays, after.arrays)):
        return None
    old, new = before.document, after.document
    removed = [i for i in before.elements if i not in after.elements]
    added = _added(list(before.elements), list(after.elements))
    disconnected, connected = _wires(old, new, set(removed))
    if added is None or disconnected is None:
        return None
    changed = [e for i, e in after.elements.items() if before.elements.get(i) != e]
    moved = {e.id: made_of(PathView, e) for e in changed if _has_moved(before.elements.get(e.id), e)}
    layout, boxes = _layout(shown_layout(old), shown_layout(new))
    return made_of(
        Edited,
        status,
        elements=[e for e in changed if e.id not in moved],
        moved=moved,
        added=added,
        removed=removed,
        disconnected=disconnected,
        connected=connected,
        groups=None if old.groups == new.groups else [list(g) for g in new.groups],
        axes=None if list(before.axes.items()) == list(after.axes.items()) else axes(after),
        parameters=None if old.parameters == new.parameters else parameters(new),
        general=_general(old, new),
        layout=layout,
        layout_entries=boxes,
        problems=list(problems()) if after.problems or before.problems else None,
    )


def _has_moved(before: ElementView | None, after: ElementView) -> bool:
    """Return whether only the path of an element is another one."""
    if before is None or before.path == after.path:
        return False
    moved = msgspec.structs.replace(before, path=after.path, name=after.name, group=after.group)
    return moved == after


def _added(before: Sequence[H], after: Sequence[H]) -> dict[H, int] | None:
    """Return what is new in a sequence, with its index; None if the order of the rest changed."""
    known, there = set(before), set(after)
    if [x for x in before if x in there] != [x for x in after if x in known]:
        return None
    return {x: k for k, x in enumerate(after) if x not in known}


def _wires(
    old: Document, new: Document, removed: Collection[str]
) -> tuple[list[EndsView] | None, list[PlacedConnection]]:
    """Return the connections that were removed beside those of removed elements, and the new ones.

    The first is None if the order of the others changed.
    """
    if old.connections is new.connections:
        return [], []
    added = _added(old.connections, new.connections)
    if added is None:
        return None, []
    kept = set(new.connections)
    gone = [
        made_of(EndsView, c)
        for c in old.connections
        if c not in kept and c.source not in removed and c.target not in removed
    ]
    return gone, [PlacedConnection(index=k, connection=made_of(ConnectionView, c)) for c, k in added.items()]


def _general(old: Document, new: Document) -> GeneralView | None:
    if all(getattr(old, key) == getattr(new, key) for key in ("name", "time_unit", "dt", "notes")):
        return None
    return made_of(GeneralView, new, title=new.name)


def shown_layout(doc: Document) -> Mapping[str, Any]:
    """Return the layout that the page gets: without the import report, which is a message of its own."""
    return stored_report.without_report(doc).layout


def _layout(
    old: Mapping[str, Any], new: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Return the keys of a layout that changed, None for removed ones, and the entries that changed inside
    keys that hold objects in both.
    """
    whole: dict[str, Any] = {}
    inside: dict[str, dict[str, Any]] = {}
    if old is new:
        return whole, inside
    for key in {**old, **new}:
        a, b = old.get(key), new.get(key)
        if a is b or a == b:
            continue
        if isinstance(a, dict) and isinstance(b, dict):
            inside[key] = {k: b.get(k) for k in {**a, **b} if a.get(k) != b.get(k)}
        else:
            whole[key] = b
    return whole, inside


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
