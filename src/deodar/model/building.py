"""Edits as a person makes them with a mouse: each is one new document, composed of those of `edit`.

Positions are those of the boxes of the studio's graph: `layout["boxes"]`, by id. Names that are taken become
free ones: `u` becomes `u2`.
"""

from __future__ import annotations

import dataclasses as dc
import itertools
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, cast

from deodar.codec import Json
from deodar.errors import ModelError, UnknownName, did_you_mean
from deodar.model import edit, find, new_elements
from deodar.model.document import Connection, Document, Entry
from deodar.model.document_graph import graph
from deodar.model.paths import PathNames, display
from deodar.model.stated_ports import without_stated_ports
from deodar.numerics.axes import Axes

BoxPosition = tuple[float, float]
EndPorts = tuple[str, str, str, str]
"""Source id and port, target id and port; an empty port means the default one."""

BOXES = "boxes"
"""Key of the layout for the positions of boxes: `{id: {"x": 0, "y": 0}}`."""

COMMENTS = "comments"
"""Key of the layout for comments: `{id: {"text": "", "x": 0, "y": 0}}`."""

APART: BoxPosition = (240.0, 140.0)
"""Distance of boxes that get positions here, along both directions."""

ElementPort = tuple[str, str]
"""Element id and port; an empty port means the default one."""


@dc.dataclass(frozen=True)
class Around:
    """What a new element is connected with.

    Attributes:
        source: output port that it reads.
        target: input port that reads it.
        wire: connection that it is inserted into.
        replaces: connection that is removed.
    """

    source: ElementPort | None = None
    target: ElementPort | None = None
    wire: EndPorts | None = None
    replaces: EndPorts | None = None


def add(
    doc: Document,
    kind: str,
    values: Mapping[str, Any],
    name: str = "",
    group: PathNames = (),
    at: BoxPosition | None = None,
    around: Around = Around(),
) -> tuple[Document, list[str]]:
    """Return a document with a new element of a kind, its connections and its position; and its id.

    Parameters that `values` does not give have starting values (`new_elements.element`), axes those of the
    ports that it is connected with.
    """
    doc = disconnect(doc, [] if around.replaces is None else [around.replaces])
    wire = None if around.wire is None else connection(doc, around.wire)
    source = around.source if wire is None else (wire.source, wire.source_port)
    target = around.target if wire is None else (wire.target, wire.target_port)
    arriving, taken = axes_around(doc, source, target)
    axes = arriving if taken is None else taken
    name = free_name(doc, group, name or _words(kind))
    element = new_elements.element(doc, kind, name, values, axes, arriving)
    doc, entry = edit.add(doc, element, group)
    if wire is not None:
        doc = edit.disconnect(doc, *wire.ends)
    if source is not None:
        reads = "" if wire is None else wire.reads
        doc = edit.connect(doc, find.entry(doc, source[0]), source[1], entry, "", reads)
    if target is not None:
        doc = edit.connect(doc, entry, "", find.entry(doc, target[0]), target[1])
    return placed(doc, {} if at is None else {entry.id: at}), [entry.id]


def insert_element(doc: Document, ident: str, ends: EndPorts) -> Document:
    """Return a document in which an element is inserted into a connection, by its default ports.

    The connection into it keeps what the former connection read.
    """
    wire, entry = connection(doc, ends), find.entry(doc, ident)
    if ident in (wire.source, wire.target):
        raise ModelError(f"{entry.path} is an end of this connection", fix="Choose another connection")
    doc = edit.disconnect(doc, *wire.ends)
    doc = edit.connect(doc, find.entry(doc, wire.source), wire.source_port, entry, "", wire.reads)
    return edit.connect(doc, entry, "", find.entry(doc, wire.target), wire.target_port)


def connect(doc: Document, ends: EndPorts, reads: str = "") -> Document:
    """Return a document with one more connection."""
    return edit.connect(doc, find.entry(doc, ends[0]), ends[1], find.entry(doc, ends[2]), ends[3], reads)


def reconnect(doc: Document, old: EndPorts, new: EndPorts) -> Document:
    """Return a document in which a connection has other ends; it keeps what it reads."""
    before = connection(doc, old)
    doc = edit.disconnect(doc, *before.ends)
    return connect(doc, new, before.reads if before.ends[:2] == new[:2] else "")


def disconnect(doc: Document, ends: Iterable[EndPorts]) -> Document:
    """Return a document without some connections."""
    for ports in ends:
        doc = edit.disconnect(doc, *connection(doc, ports).ends)
    return doc


def remove(
    doc: Document, ids: Iterable[str], groups: Iterable[PathNames] = (), connections: Iterable[EndPorts] = ()
) -> Document:
    """Return a document without some connections, elements, and groups with their content."""
    doc = disconnect(doc, connections)
    listed = [require_group(doc, g) for g in groups]
    gone = members(doc, ids, listed)
    doc = edit.remove(doc, gone)
    for g in listed:
        doc = edit.remove_group(doc, g)
    return placed(without_stated_ports(doc, gone), dict.fromkeys(gone))


def rename(doc: Document, ident: str, name: str) -> Document:
    """Return a document in which an element has another name."""
    return edit.move(doc, ident, (*find.entry(doc, ident).group, name))


def rename_group(doc: Document, group: PathNames, name: str) -> Document:
    """Return a document in which a group has another name."""
    return edit.move_group(doc, require_group(doc, group), (*group[:-1], name))


def move_into(doc: Document, ids: Sequence[str], groups: Iterable[PathNames], group: PathNames) -> Document:
    """Return a document in which elements and groups lie in another group; `()` is the top level."""
    if group:
        require_group(doc, group)
    outer = _outermost([require_group(doc, g) for g in groups])
    free = _FreeNames(doc, group)
    moved = {g: (*group, free.take(g[-1])) for g in outer if g[:-1] != group}
    alone = [e for e in (find.entry(doc, i) for i in dict.fromkeys(ids)) if not _lies_in(e.names, outer)]
    elements = {e.id: (*group, free.take(e.names[-1])) for e in alone if e.group != group}
    return edit.relocate(doc, elements, moved)


def group(
    doc: Document,
    ids: Sequence[str],
    groups: Sequence[PathNames],
    name: str = "",
    at: BoxPosition | None = None,
) -> tuple[Document, PathNames]:
    """Return a document in which elements and groups lie in a new group, and the path of that group.

    The new group lies where all of them lie. `at`: their boxes are moved to there together.
    """
    parents = [find.entry(doc, i).group for i in ids] + [require_group(doc, g)[:-1] for g in groups]
    common = shared(parents)
    path = (*common, free_name(doc, common, name or "group"))
    doc = move_into(edit.group(doc, path), ids, groups, path)
    inside = [e.id for e in doc.entries if e.names[: len(path)] == path]
    return (doc if at is None else placed(doc, _moved(positions(doc), inside, at))), path


def ungroup(doc: Document, group: PathNames) -> Document:
    """Return a document in which the content of a group has moved to the parent of the group."""
    parent = require_group(doc, group)[:-1]
    free = _FreeNames(doc, parent, without=group[-1])
    elements = {e.id: (*parent, free.take(e.names[-1])) for e in doc.entries if e.group == group}
    inner = {g: (*parent, free.take(g[-1])) for g in doc.groups if g[:-1] == group}
    return edit.relocate(doc, elements, {**inner, group: parent}, {group})


def excerpt(doc: Document, ids: Iterable[str], groups: Iterable[PathNames] = ()) -> Document:
    """Return a document with some elements and groups alone: their connections, links and positions.

    Paths begin at the group that contains all of them.
    """
    listed = [require_group(doc, g) for g in groups]
    ids = list(ids)
    chosen = set(members(doc, ids, listed))
    common = shared([find.entry(doc, i).group for i in ids] + [g[:-1] for g in listed])
    empty = edit.describe(Document(doc.name), time_unit=doc.time_unit, dt=doc.dt)
    for g in doc.groups:
        if any(g[: len(path)] == path for path in listed):
            empty = edit.group(empty, g[len(common) :])
    out = edit.insert(empty, doc, lambda names: names[len(common) :], chosen)
    return _with_positions(out, doc, [e for e in doc.entries if e.id in chosen], (0.0, 0.0))


def paste(
    doc: Document, template: Document, group: PathNames = (), at: BoxPosition | None = None
) -> tuple[Document, list[str]]:
    """Return a document with the content of another one in a group, and the new ids.

    Elements and groups of the other document keep their names where these are free. `at` is the position of
    the upper left corner; None: beside their positions in the other document.
    """
    first = list(
        dict.fromkeys(names[0] for names in (*(e.names for e in template.entries), *template.groups))
    )
    if group:
        doc = edit.group(doc, group)
    names: dict[str, str] = {}
    for name in first:
        names[name] = free_name(doc, group, name, names.values())
    count = len(doc.entries)
    doc = edit.insert(doc, template, lambda path: (*group, *_first(path, names)))
    new = doc.entries[count:]
    boxes = positions(template)
    corner = _corner([boxes[e.id] for e in template.entries if e.id in boxes])
    shift = (24.0, 24.0) if at is None else (at[0] - corner[0], at[1] - corner[1])
    return _with_positions(doc, template, list(template.entries), shift, at), [e.id for e in new]


def insert(
    doc: Document, template: Document, name: str, group: PathNames = (), at: BoxPosition | None = None
) -> tuple[Document, list[str], PathNames]:
    """Return a document with the content of another one in a new group, the new ids, and the group's path."""
    path = (*group, free_name(doc, group, name))
    new, ids = paste(doc, template, path, at)
    return new, ids, path


def comment(doc: Document, ident: str, values: Mapping[str, Json] | None) -> tuple[Document, str]:
    """Return a document with a comment on its graph, and the comment's id.

    Comments are kept in the layout and have no effect on the model.

    Args:
        doc: the document.
        ident: id of the comment; empty: a new one.
        values: what changes of it, such as its text and position; None removes it.
    """
    comments = doc.layout.get(COMMENTS)
    by_id = dict(cast("dict[str, Any]", comments)) if isinstance(comments, dict) else {}
    if ident and ident not in by_id:
        raise UnknownName(f"there is no comment {ident!r}")
    ident = ident or next(f"c{n}" for n in itertools.count(1) if f"c{n}" not in by_id)
    if values is None:
        by_id.pop(ident, None)
    else:
        old = by_id.get(ident)
        by_id[ident] = {**(cast("dict[str, Any]", old) if isinstance(old, dict) else {}), **values}
    layout = {k: v for k, v in {**doc.layout, COMMENTS: by_id or None}.items() if v is not None}
    return edit.arrange(doc, layout), ident


def placed(doc: Document, boxes: Mapping[str, BoxPosition | None]) -> Document:
    """Return a document in which boxes have other positions; None removes a position."""
    old = cast("dict[str, Any]", doc.layout.get(BOXES) or {})
    if not isinstance(old, dict):
        old = {}
    new = {k: v for k, v in old.items() if boxes.get(k, ()) is not None}
    new |= {k: _box(old.get(k), at) for k, at in boxes.items() if at is not None}
    if new == old:
        return doc
    layout = {k: v for k, v in {**doc.layout, BOXES: new or None}.items() if v is not None}
    return edit.arrange(doc, layout)


def _box(stored: Json, at: BoxPosition) -> Json:
    """Return a box at another position, with all else that the layout holds of it."""
    return {**(stored if isinstance(stored, dict) else {}), "x": at[0], "y": at[1]}


def positions(doc: Document) -> dict[str, BoxPosition]:
    """Return the positions of boxes that the layout holds; anything else in it is ignored."""
    boxes = doc.layout.get(BOXES)
    out: dict[str, BoxPosition] = {}
    for ident, box in (cast("dict[str, Any]", boxes) if isinstance(boxes, dict) else {}).items():
        x, y = (box.get("x"), box.get("y")) if isinstance(box, dict) else (None, None)
        if isinstance(x, (int, float)) and isinstance(y, (int, float)):
            out[ident] = (float(x), float(y))
    return out


def free_name(doc: Document, group: PathNames, base: str, besides: Collection[str] = ()) -> str:
    """Return a name that nothing in a group has: the given one, or one with another number at its end."""
    taken, groups, parameters = doc.by_names(), set(doc.groups), {k.name for k in doc.parameters}

    def is_taken(name: str) -> bool:
        path = (*group, name)
        return path in taken or path in groups or name in besides or display(path) in parameters

    if not is_taken(base):
        return base
    stem = re.sub(r"\d+$", "", base) or base
    n = 2
    while is_taken(f"{stem}{n}"):
        n += 1
    return f"{stem}{n}"


class _FreeNames:
    """Names that nothing in a group has, for several elements and groups that move there.

    Args:
        doc: the document.
        group: the group.
        without: name of something in the group that is going to be removed.
    """

    def __init__(self, doc: Document, group: PathNames, without: str = "") -> None:
        depth = len(group)
        paths = [*(e.names for e in doc.entries), *doc.groups]
        self._taken = {p[depth] for p in paths if len(p) > depth and p[:depth] == group} - {without}
        self._group = group
        self._parameters = {k.name for k in doc.parameters}
        self._last: dict[str, int] = {}

    def take(self, base: str) -> str:
        """Return a free name, which then is taken: the given one, or one with another number at its end."""
        name, stem = base, re.sub(r"\d+$", "", base) or base
        while name in self._taken or (self._parameters and display((*self._group, name)) in self._parameters):
            self._last[stem] = self._last.get(stem, 1) + 1
            name = f"{stem}{self._last[stem]}"
        self._taken.add(name)
        return name


def connection(doc: Document, ends: EndPorts) -> Connection:
    """Return the connection between two ports; an empty port means the default one."""
    source, target = find.entry(doc, ends[0]), find.entry(doc, ends[2])
    outs, ins = find.outputs(source), target.element.ports()
    ports = (
        source.id,
        ends[1] or (outs[0] if outs else ""),
        target.id,
        ends[3] or (ins[0] if ins else ""),
    )
    match = next((c for c in doc.connections if c.ends == ports), None)
    if match is None:
        raise UnknownName(f"{source.path}.{ports[1]} is not connected to {target.path}.{ports[3]}")
    return match


def members(doc: Document, ids: Iterable[str], groups: Sequence[PathNames]) -> list[str]:
    """Return the ids of elements and of all elements in groups, each once, in the document's order."""
    chosen = {find.entry(doc, i).id for i in ids}
    return [e.id for e in doc.entries if e.id in chosen or _lies_in(e.names, groups)]


def require_group(doc: Document, names: PathNames) -> PathNames:
    """Return the path of a group; raise UnknownName if the document has no such group."""
    if names not in doc.groups:
        paths = [display(g) for g in doc.groups]
        raise UnknownName(f"there is no group {display(names)!r}", fix=did_you_mean(display(names), paths))
    return names


def shared(paths: Sequence[PathNames]) -> PathNames:
    """Return the longest path that all paths begin with."""
    if not paths:
        raise ModelError("nothing is selected", fix="Name at least one element or group")
    out = paths[0]
    for path in paths[1:]:
        same = next((k for k, (a, b) in enumerate(zip(out, path, strict=False)) if a != b), None)
        out = out[: min(len(out), len(path)) if same is None else same]
    return out


def axes_around(
    doc: Document, source: ElementPort | None, target: ElementPort | None
) -> tuple[Axes | None, Axes | None]:
    """Return the axes of an output port and of an input port; None where they are unknown."""
    if source is None and target is None:
        return None, None
    nodes = {n.id: n for n in graph(doc).nodes}
    port_axes: list[Axes | None] = []
    for end, of in ((source, "outs"), (target, "ins")):
        node = nodes.get(find.entry(doc, end[0]).id) if end is not None else None
        ports: Mapping[str, Axes] = {} if node is None else getattr(node, of)
        name = "" if end is None else end[1] or next(iter(ports), "")
        port_axes.append(ports.get(name))
    return port_axes[0], port_axes[1]


def _lies_in(names: PathNames, groups: Iterable[PathNames]) -> bool:
    return any(names[: len(g)] == g for g in groups)


def _outermost(groups: Sequence[PathNames]) -> list[PathNames]:
    """Return the groups, each once, that lie in no other one of them."""
    return [g for g in dict.fromkeys(groups) if not any(_lies_in(g, [o]) for o in groups if o != g)]


def _words(kind: str) -> str:
    """Return the name of a kind as a name of an element: `gaussian_stimulus`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", kind).lower()


def _first(path: PathNames, names: Mapping[str, str]) -> PathNames:
    return (names.get(path[0], path[0]), *path[1:])


def _corner(at: Sequence[BoxPosition]) -> BoxPosition:
    return (min(x for x, _ in at), min(y for _, y in at)) if at else (0.0, 0.0)


def _moved(boxes: Mapping[str, BoxPosition], ids: Sequence[str], at: BoxPosition) -> dict[str, BoxPosition]:
    """Return positions that are moved together, so that their corner is at `at`."""
    inside = {i: boxes[i] for i in ids if i in boxes}
    corner = _corner(list(inside.values()))
    return {i: (x + at[0] - corner[0], y + at[1] - corner[1]) for i, (x, y) in inside.items()}


def _with_positions(
    doc: Document,
    template: Document,
    copied: Sequence[Entry],
    shift: BoxPosition,
    at: BoxPosition | None = None,
) -> Document:
    """Return a document whose last entries, copies of others, have their positions, moved by `shift`.

    If `at` is given and no copied element has a position, they are placed in columns, sources to the left.
    """
    boxes, new = positions(template), doc.entries[len(doc.entries) - len(copied) :]
    if at is not None and not any(e.id in boxes for e in copied):
        boxes, shift = columns(template), at
    moved = {
        entry.id: (boxes[old.id][0] + shift[0], boxes[old.id][1] + shift[1])
        for old, entry in zip(copied, new, strict=True)
        if old.id in boxes
    }
    return placed(doc, moved)


def columns(doc: Document) -> dict[str, BoxPosition]:
    """Return positions of all boxes in columns: an element is to the right of what it reads."""
    sources: dict[str, list[str]] = {e.id: [] for e in doc.entries}
    targets: dict[str, list[str]] = {e.id: [] for e in doc.entries}
    for c in doc.connections:
        sources[c.target].append(c.source)
        targets[c.source].append(c.target)
    waits = {i: len(ids) for i, ids in sources.items()}
    column: dict[str, int] = {}
    while len(column) < len(waits):
        # in a loop, the element that waits for the fewest others comes first
        unplaced = [i for i in waits if i not in column]
        ready = [i for i in unplaced if waits[i] == 0] or [min(unplaced, key=waits.__getitem__)]
        for i in ready:  # the list grows during the loop
            column[i] = 1 + max((column[s] for s in sources[i] if s in column), default=-1)
            for target in targets[i]:
                waits[target] -= 1
                if waits[target] == 0 and target not in column and target not in ready:
                    ready.append(target)
    rows: dict[int, int] = {}
    out: dict[str, BoxPosition] = {}
    for e in doc.entries:
        x = column[e.id]
        out[e.id] = (APART[0] * x, APART[1] * rows.get(x, 0))
        rows[x] = rows.get(x, 0) + 1
    return out
