"""Operations that make a new document from a document. No other module makes documents.

Each is a pure function. Rename, grouping and moves preserve ids; a copy gets new ids. `UndoHistory` adds undo
and redo.
"""

from __future__ import annotations

import dataclasses as dc
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, Generic, TypeVar

from deodar import codec
from deodar.codec import Json
from deodar.element import Element
from deodar.errors import DeodarError, ModelError, ParameterError, UnknownName, did_you_mean
from deodar.leaves import replace
from deodar.model import find
from deodar.model.axis_removal import AxisRemoval
from deodar.model.document import READS, Connection, Document, DocumentParameter, Entry, Leaf, Use
from deodar.model.paths import PathNames, as_taken, display, stored_id
from deodar.numerics.axes import Axis
from deodar.parameters import Reference, is_text, parameters, real, show

T = TypeVar("T")

TIME_UNIT = re.compile(r"^(us|ms|s|min|abstract|1 = \d+(\.\d+)?(e[+-]?\d+)? (us|ms|s|min))$")

GENERAL = ("name", "time_unit", "dt", "t0", "notes", "layout")
MOST_TICKS = 1_000_000
"""Longest step of an element in ticks: a thousand seconds at 1 ms (a guess: a longer one is probably a
typo).
"""


def add(
    doc: Document,
    element: Element,
    group: PathNames = (),
    every: int = 1,
    after: Entry | None = None,
    ident: str = "",
) -> tuple[Document, Entry]:
    """Return a document with one more element.

    An element without a name is named after the element `after` that it reads: `u>Gain`, `u>Gain2`. `ident`
    is its id; empty: the one that follows from its path.
    """
    if isinstance(element, Element) and not element.name:
        base = name_after(after, element) if after else type(element).__name__
        group = group or after.group if after else group
        element = dc.replace(element, name=_free(base, lambda name: _is_taken(doc, (*group, name))))
    if ident:
        require_id(ident, doc.by_id())
    doc, entries = add_all(doc, [(element, group, every)], ident)
    return doc, entries[0]


def name_after(source: Entry, element: Element) -> str:
    """Return the name of an element without a name of its own that reads `source`; a number may follow."""
    return f"{source.names[-1]}>{type(element).__name__}"


def is_unnamed(name: str, element: Element) -> bool:
    """Return whether a name is one that `add` gives to an element without a name, after what it reads."""
    return ">" in name and name.rsplit(">", 1)[1].rstrip("0123456789") == type(element).__name__


def add_all(
    doc: Document, elements: Iterable[tuple[Element, PathNames, int]], ident: str = ""
) -> tuple[Document, list[Entry]]:
    """Return a document with more elements, given as (element, group, step in ticks); every element has a
    name. `ident`: the id of a single element, if it does not follow from its path.
    """
    entries: list[Entry] = []
    taken, ids, groups = dict(doc.by_names()), dict(doc.by_id()), set(doc.groups)
    for element, group, every in elements:
        if not isinstance(element, Element):
            raise ModelError(
                f"{element!r} is not an element",
                fix="Add a field, a stimulus or a coupling: model.add(dd.Field('u', [x]))",
            )
        require_ticks(every, element.name)
        names = (*group, element.name)
        _vacant(doc, names, taken, groups)
        _unambiguous(doc, names, element)
        path = display(names)
        entry = Entry(ident or stored_id(path, ids), names, element, every)
        entries.append(entry)
        taken[names] = entry
        ids[entry.id] = entry
        groups |= {group[:k] for k in range(1, len(group) + 1)}
    return doc.extended(entries, _with_groups(doc.groups, [e.group for e in entries])), entries


def remove(doc: Document, ids: Iterable[str]) -> Document:
    """Return a document without these elements, their connections and their links."""
    gone = set(ids)
    linked = tuple(dc.replace(k, links=tuple(x for x in k.links if x[0] not in gone)) for k in doc.parameters)
    connections = tuple(c for c in doc.connections if not gone & {c.source, c.target})
    uses = tuple(dc.replace(u, elements=tuple(x for x in u.elements if x[1] not in gone)) for u in doc.uses)
    return dc.replace(
        doc,
        entries=tuple(e for e in doc.entries if e.id not in gone),
        connections=connections,
        parameters=linked,
        uses=uses,
    )


def remove_group(doc: Document, group: PathNames) -> Document:
    """Return a document without a group and its content."""
    doc = remove(doc, [e.id for e in doc.entries if e.names[: len(group)] == group])
    uses = tuple(u for u in doc.uses if u.group[: len(group)] != group)
    return dc.replace(doc, groups=tuple(g for g in doc.groups if g[: len(group)] != group), uses=uses)


def move(doc: Document, ident: str, names: PathNames) -> Document:
    """Return a document in which an element has another path; its id does not change."""
    entry = find.entry(doc, ident)
    if names == entry.names:
        return doc
    _vacant(doc, names)
    _unambiguous(doc, names, entry.element)
    moved = dc.replace(entry, names=names, element=dc.replace(entry.element, name=names[-1]))
    groups = _with_groups(doc.groups, [names[:-1]])
    return dc.replace(doc, entries=tuple(moved if e.id == ident else e for e in doc.entries), groups=groups)


def move_group(doc: Document, group: PathNames, to: PathNames) -> Document:
    """Return a document in which a group with its content has another path."""
    return doc if to == group else relocate(doc, {}, {group: to})


def ungroup(doc: Document, group: PathNames) -> Document:
    """Return a document in which the content of a group has moved to the parent of the group."""
    return relocate(doc, {}, {group: group[:-1]}, {group})


def relocate(
    doc: Document,
    elements: Mapping[str, PathNames],
    groups: Mapping[PathNames, PathNames],
    dissolved: Collection[PathNames] = (),
) -> Document:
    """Return a document in which elements and groups with their content have other paths, all at once.

    Args:
        doc: the document.
        elements: new paths by id.
        groups: new paths by path.
        dissolved: groups among them that are removed; their content moves to their new path.
    """
    for group, to in groups.items():
        if to[: len(group)] == group and to != group:
            raise ModelError(f"the group {display(group)!r} cannot be moved into itself")

    def new_path(names: PathNames) -> PathNames:
        inner = next((names[:k] for k in range(len(names), 0, -1) if names[:k] in groups), None)
        return names if inner is None else groups[inner] + names[len(inner) :]

    paths = {e.id: elements.get(e.id) or new_path(e.names) for e in doc.entries}
    moved = [e for e in doc.entries if paths[e.id] != e.names]
    group_paths = {g: new_path(g) for g in doc.groups if g not in dissolved}
    _require_vacant(doc, [(e, paths[e.id]) for e in moved], group_paths)
    entries = tuple(e if paths[e.id] == e.names else _renamed(e, paths[e.id]) for e in doc.entries)
    inside = _with_groups((), [*group_paths.values(), *groups.values(), *(paths[e.id][:-1] for e in moved)])
    uses = tuple(dc.replace(u, group=new_path(u.group)) for u in doc.uses if u.group not in dissolved)
    return dc.replace(doc, entries=entries, groups=inside, uses=uses)


def _require_vacant(
    doc: Document, moved: Sequence[tuple[Entry, PathNames]], groups: Mapping[PathNames, PathNames]
) -> None:
    """Refuse the new paths of elements and groups if they are taken once all are moved."""
    taken = dict(doc.by_names())
    for e, _ in moved:
        del taken[e.names]
    occupied = {g for g, to in groups.items() if g == to}
    for to in [to for g, to in groups.items() if g != to]:
        _vacant(doc, to, taken, occupied)
        occupied.add(to)
    for e, to in moved:
        _vacant(doc, to, taken, occupied)
        _unambiguous(doc, to, e.element)
        taken[to] = e


def _renamed(entry: Entry, names: PathNames) -> Entry:
    return dc.replace(entry, names=names, element=dc.replace(entry.element, name=names[-1]))


def group(doc: Document, names: PathNames) -> Document:
    """Return a document with one more (empty) group; the same document if the group exists."""
    if names in doc.groups:
        return doc
    _vacant(doc, names)
    return dc.replace(doc, groups=_with_groups(doc.groups, [names]))


def copy(doc: Document, ids: Iterable[str], place: Callable[[PathNames], PathNames]) -> Document:
    """Return a document with copies of elements, each at `place(its path)`, and of the connections and links
    among them.
    """
    return insert(doc, doc, place, set(ids))


def insert(
    doc: Document,
    template: Document,
    place: Callable[[PathNames], PathNames],
    ids: set[str] | None = None,
    linked: bool = False,
) -> Document:
    """Return a document with copies of a template's elements, connections and document parameters.

    The copies have new ids. `ids` are those of the elements to copy; None: all, with the groups.

    With `linked`, the document stores which element is a copy of which (`uses.refresh`). Groups of the
    template that are linked to another template stay linked to it.
    """
    placed = [(e, place(e.names)) for e in template.entries if ids is None or e.id in ids]
    doc, entries = add_all(
        doc, [(dc.replace(e.element, name=names[-1]), names[:-1], e.every) for e, names in placed]
    )
    new = {e.id: entry.id for (e, _), entry in zip(placed, entries, strict=True)}
    inside = [
        dc.replace(c, source=new[c.source], target=new[c.target])
        for c in template.connections
        if c.source in new and c.target in new
    ]
    doc = dc.replace(doc, connections=(*doc.connections, *inside))
    doc = _with_links(doc, template, new)
    groups, uses = list[PathNames](), list[Use]()

    def group_at(names: PathNames) -> PathNames:
        return place((*names, ""))[:-1]

    if ids is None:
        groups = [at for g in template.groups if (at := group_at(g))]
        uses = [
            Use(group_at(u.group), u.template, tuple((t, new[i]) for t, i in u.elements))
            for u in template.uses
        ]
    if linked:
        uses.append(Use(group_at(()), template.name, tuple(new.items())))
    return dc.replace(
        doc,
        groups=_with_groups(doc.groups, groups),
        uses=(*doc.uses, *uses),
        foreign=doc.foreign or template.asks(),
    )


def _with_links(doc: Document, template: Document, new: Mapping[str, str]) -> Document:
    """Return a document in which a template's document parameters drive the copies; `new` has their ids."""
    for k in template.parameters:
        links = [(new[i], leaf) for i, leaf in k.links if i in new]
        if links and k.name not in [j.name for j in doc.parameters]:
            doc = document_parameter(doc, k.name, k.value)
        for i, leaf in links:
            doc = link(doc, i, leaf, k.name)
    return doc


def connect(
    doc: Document, source: Entry, source_port: str, target: Entry, target_port: str, reads: str = ""
) -> Document:
    """Return a document with one more connection. An empty port means the default one: the output, the first
    input.
    """
    outs, ins = find.outputs(source), target.element.ports()
    for path, ports, side in ((target.path, ins, "input"), (source.path, outs, "output")):
        if not ports:
            raise ModelError(f"{path} has no {side} port", where=f"{source.path} -> {target.path}")
    source_port, target_port = source_port or outs[0], target_port or ins[0]
    if source_port not in outs:
        fault = "is an input port" if source_port in source.element.ports() else "does not exist"
        raise UnknownName(
            f"the output port {source_port!r} of {source.path} {fault}", fix=did_you_mean(source_port, outs)
        )
    if target_port not in ins:
        raise UnknownName(
            f"{target.path} has no input port {target_port!r}", fix=did_you_mean(target_port, ins)
        )
    if reads not in READS:
        raise ParameterError(
            f"reads is {reads!r}; expected previous, current or delayed",
            where=f"{source.path} -> {target.path}",
        )
    new = Connection(source.id, source_port, target.id, target_port, reads)
    if new.ends in doc.ends():
        raise ModelError(
            f"{source.path}.{source_port} is already connected to {target.path}.{target_port}",
            fix="To count it twice, put a Gain between them",
        )
    return doc.connected(new)


def disconnect(doc: Document, source: str, source_port: str, target: str, target_port: str) -> Document:
    """Return a document without one connection."""
    ends = (source, source_port, target, target_port)
    if all(c.ends != ends for c in doc.connections):
        by = doc.by_id()
        raise UnknownName(
            f"{by[source].path}.{source_port} is not connected to {by[target].path}.{target_port}"
        )
    return dc.replace(doc, connections=tuple(c for c in doc.connections if c.ends != ends))


def replace_connections(doc: Document, old: Collection[Connection], new: Iterable[Connection]) -> Document:
    """Return a document with other connections in the place of some, where the first of these was."""
    first = next(k for k, c in enumerate(doc.connections) if c in old)
    before, after = doc.connections[:first], [c for c in doc.connections[first:] if c not in old]
    return dc.replace(doc, connections=(*before, *new, *after))


def set_reads(doc: Document, ends: tuple[str, str, str, str], reads: str) -> Document:
    """Return a document in which a connection, given by its ends, reads another instant."""
    return _reconnected(doc, ends, ends[1], reads)


def set_source_port(doc: Document, ends: tuple[str, str, str, str], port: str) -> Document:
    """Return a document in which a connection, given by its ends, reads another output port of its source."""
    reads = [c.reads for c in doc.connections if c.ends == ends]
    return _reconnected(doc, ends, port, *reads)


def _reconnected(
    doc: Document, ends: tuple[str, str, str, str], source_port: str, reads: str = ""
) -> Document:
    """Return a document with another connection between two elements, in the place of the one before."""
    source, target = (find.entry(doc, ident) for ident in (ends[0], ends[2]))
    new = connect(disconnect(doc, *ends), source, source_port, target, ends[3], reads).connections[-1]
    return replace_connections(doc, [c for c in doc.connections if c.ends == ends], [new])


def put(doc: Document, ident: str, path: str, value: Any) -> Document:
    """Return a document with another value of one parameter of an element; a linked parameter is refused."""
    entry = find.entry(doc, ident)
    if path.split(".")[0] == "name":
        raise ParameterError(
            "a name is changed by renaming the element", where=entry.path, fix="model.rename(path, name)"
        )
    for (i, leaf), name in doc.links().items():
        if i == ident and (leaf == path or leaf.startswith(path + ".") or path.startswith(leaf + ".")):
            raise ParameterError(
                f"{entry.path}.{leaf} is driven by the document parameter {name!r}",
                fix=f"Set {name!r} instead, or unlink {entry.path}.{leaf}",
            )
    return _put(doc, ident, path, value)


def change(doc: Document, path: str, value: Any) -> Document:
    """Return a document with another value at a path: of a parameter of an element, or of a document
    parameter.
    """
    target = find.target(doc, path)
    return (
        document_parameter(doc, target.parameter, value)
        if target.entry is None
        else put(doc, target.entry.id, target.parameter, value)
    )


def change_all(doc: Document, values: Mapping[str, Any]) -> Document:
    """Return a document with other values at several paths; the error lists every value that is refused."""
    errors: list[DeodarError] = []
    for path, value in values.items():
        try:
            doc = change(doc, path, value)
        except DeodarError as error:
            errors.append(error)
    if len(errors) > 1:
        raise type(errors[0])([problem for error in errors for problem in error.problems])
    if errors:
        raise errors[0]
    return doc


def assignments(path: Any, value: Any) -> Mapping[str, Any]:
    """Return the arguments of `set` as values by path: `set(path, value)` or `set({path: value, ...})`."""
    if isinstance(path, Mapping):
        if value is not ...:
            raise ParameterError(
                "set takes one value for several parameters only as part of them",
                fix='Write: set({"u.tau": 30, "v.tau": 30})',
            )
        values: Mapping[Any, Any] = path
    elif value is ...:
        raise ParameterError(
            f"set needs a value for {show(path)}",
            fix=f"Write: set({codec.line(path) if isinstance(path, str) else 'path'}, value)",
        )
    else:
        values = {path: value}
    for key in values:
        if not isinstance(key, str):
            raise ParameterError(f"expected a path, got {show(key)}", fix="Write it as text: 'u.tau'")
    return {
        key: values[key].__value__() if isinstance(values[key], Reference) else values[key] for key in values
    }


def add_axis(doc: Document, axis: Axis) -> Document:
    """Return a document with one more axis, which no element has yet.

    Raises:
        ModelError: the document has the axis already.
        ParameterError: it is another object, such as a name.
    """
    if not isinstance(axis, Axis):
        raise ParameterError(
            f"expected an Axis, got {show(axis)}",
            fix="Write: model.add_axis(dd.Axis('x', 0, 100, 101))",
        )
    if has_axis(doc, axis):
        raise ModelError(f"the document already has the axis {axis}", fix="Choose it at an element")
    return dc.replace(doc, spare_axes=(*doc.spare_axes, axis))


def remove_axis(doc: Document, axis: Axis) -> Document:
    """Return a document without an axis: elements over several axes lose this one, with what they state for
    it alone, such as one of two widths. A document parameter no longer drives such a value.

    Raises:
        ParameterError: an element states the axis in a parameter of its own.
    """
    names = [a.name for a in {*doc.spare_axes, *(a for e in doc.entries for a in e.axes)}]
    removal = AxisRemoval(axis, axis.name if names.count(axis.name) == 1 else "")
    entries = tuple(
        e if after is e.element else dc.replace(e, element=after)
        for e in doc.entries
        for after in [removal.without(e.element, e.path)]
    )
    by = doc.by_id()

    def moved(links: Iterable[Leaf]) -> Iterator[Leaf]:
        for ident, leaf in links:
            path = removal.leaf(by[ident].element, leaf.split("."))
            if path is not None:
                yield ident, ".".join(path)

    return dc.replace(
        doc,
        entries=entries,
        parameters=tuple(dc.replace(k, links=tuple(moved(k.links))) for k in doc.parameters),
        spare_axes=tuple(a for a in doc.spare_axes if a != axis),
    )


def has_axis(doc: Document, axis: Axis) -> bool:
    """Return whether an axis is one of a document's, also one that no element has yet."""
    return axis in doc.spare_axes or any(axis in e.axes for e in doc.entries)


def replace_axis(doc: Document, old: Axis, new: Axis) -> Document:
    """Return a document in which every element and part has another axis in the place of one.

    Raises:
        ModelError: the document does not have the axis.
        ParameterError: an element cannot have the new axis, such as one with an array of the old length.
    """
    if not has_axis(doc, old):
        raise ModelError(f"no element has the axis {old}")
    return replace_axes(doc, {old: new})


def replace_axes(doc: Document, new: Mapping[Axis, Axis]) -> Document:
    """Return a document in which every element and part has other axes in the place of some, all at once: an
    axis that becomes equal to another one does not change with it.

    Raises:
        ParameterError: an element cannot have its new axes.
    """
    entries = tuple(dc.replace(e, element=_with_axes(e.element, new)) for e in doc.entries)
    return dc.replace(doc, entries=entries, spare_axes=tuple(new.get(a, a) for a in doc.spare_axes))


def every(doc: Document, ident: str, ticks: int) -> Document:
    """Return a document in which an element has another step."""
    require_ticks(ticks, find.entry(doc, ident).path)
    return dc.replace(
        doc, entries=tuple(dc.replace(e, every=ticks) if e.id == ident else e for e in doc.entries)
    )


def document_parameter(doc: Document, name: str, value: float) -> Document:
    """Return a document with a new or changed document parameter; every linked parameter gets its value."""
    number = real(value)
    if number is None or not math.isfinite(number):
        raise ParameterError(f"needs a finite number, not {show(value)}", where=str(name))
    if not isinstance(name, str) or not name or not is_text(name):
        raise ModelError(f"a document parameter needs a name, not {name!r}")
    for e in doc.entries:
        path = e.path
        if name == path or (
            name.startswith(f"{path}.")
            and name[len(path) + 1 :] in [p.name for p in parameters(type(e.element))]
        ):
            owner = "an element" if name == path else f"a parameter of {path}"
            raise ModelError(
                f"a document parameter cannot be called {name!r}: {owner} has this name",
                fix="Give it another name",
            )
    links = next((k.links for k in doc.parameters if k.name == name), ())
    for ident, leaf in links:
        doc = _put(doc, ident, leaf, number)
    new = DocumentParameter(name, number, links)
    shared = tuple(new if k.name == name else k for k in doc.parameters)
    return dc.replace(
        doc, parameters=shared if any(k.name == name for k in doc.parameters) else (*doc.parameters, new)
    )


def remove_document_parameter(doc: Document, name: str) -> Document:
    """Return a document without a document parameter; the parameters that it drove keep their values."""
    return dc.replace(doc, parameters=tuple(k for k in doc.parameters if k.name != name))


def link(doc: Document, ident: str, leaf: str, name: str) -> Document:
    """Return a document in which a document parameter drives a parameter of an element."""
    entry = find.entry(doc, ident)
    shared = next((k for k in doc.parameters if k.name == name), None)
    if shared is None:
        names = [k.name for k in doc.parameters]
        raise UnknownName(
            f"the document has no parameter {name!r}",
            fix=did_you_mean(name, names) or "Create it: model.parameter(name, value)",
        )
    find.number(doc, ident, leaf)
    if (ident, leaf) in doc.links():
        raise ModelError(
            f"{entry.path}.{leaf} is already linked to {doc.links()[ident, leaf]!r}", fix="Unlink it first"
        )
    doc = _put(doc, ident, leaf, shared.value)
    new = dc.replace(shared, links=(*shared.links, (ident, leaf)))
    return dc.replace(doc, parameters=tuple(new if k.name == name else k for k in doc.parameters))


def unlink(doc: Document, ident: str, leaf: str) -> Document:
    """Return a document in which a parameter is no longer linked; it keeps its value."""
    linked = tuple(
        dc.replace(k, links=tuple(x for x in k.links if x != (ident, leaf))) for k in doc.parameters
    )
    return dc.replace(doc, parameters=linked)


def describe(doc: Document, **values: Any) -> Document:
    """Return a document with other general properties: name, time_unit, dt, t0, notes, layout."""
    strange = [key for key in values if key not in GENERAL]
    if strange:
        raise UnknownName(f"a document has no property {strange[0]!r}", fix=did_you_mean(strange[0], GENERAL))
    for key in ("name", "notes"):
        text = values.get(key, "")
        if not isinstance(text, str) or not is_text(text):
            raise ParameterError(f"{key} needs text, not {show(text)}")
    unit = values.get("time_unit", doc.time_unit)
    if not isinstance(unit, str) or not TIME_UNIT.match(unit):
        raise ParameterError(
            f"time_unit is {show(unit)}",
            fix="Write us, ms, s, min, abstract, or for a custom unit: '1 = 64 ms'",
        )
    dt = values.get("dt", doc.dt)
    if dt is not None and not 0 < (real(dt) or 0) < math.inf:
        raise ParameterError(f"dt is {show(dt)}; expected a number above 0")
    t0 = real(values.get("t0", 0.0))
    if t0 is None or not math.isfinite(t0):
        raise ParameterError(f"t0 is {show(values['t0'])}; expected a finite number")
    for key in ("dt", "t0"):
        if values.get(key) is not None:
            values[key] = real(values[key])
    return dc.replace(doc, **values)


def arrange(doc: Document, layout: Mapping[str, Json]) -> Document:
    """Return a document with another layout (positions of boxes, panels, pinned sliders); nothing else
    changes.
    """
    return dc.replace(doc, layout=dict(layout))


def arrange_everywhere(history: UndoHistory[Document], layout: Mapping[str, Json]) -> None:
    """Change keys of the layout in all documents of a history; None removes a key.

    Of a list (folded groups) the other documents take over what was added and removed, because groups may
    have had other names.
    """
    present = history.document

    def changed(doc: Document, key: str, value: Json) -> Json:
        before, theirs = present.layout.get(key), doc.layout.get(key)
        if doc is present or not isinstance(value, list):
            return value
        old, current = (entry if isinstance(entry, list) else [] for entry in (before, theirs))
        return [
            *(entry for entry in current if entry in value or entry not in old),
            *(entry for entry in value if entry not in old and entry not in current),
        ]

    def with_layout(doc: Document) -> Document:
        new = {**doc.layout, **{key: changed(doc, key, value) for key, value in layout.items()}}
        return arrange(doc, {key: value for key, value in new.items() if value is not None})

    history.change_all(with_layout)


def rename_everywhere(history: UndoHistory[Document], name: str) -> None:
    """Change the name of the document in all documents of a history that have the present one."""
    present = history.document.name
    history.change_all(lambda doc: describe(doc, name=name) if doc.name == present else doc)


class UndoHistory(Generic[T]):
    """A sequence of documents, or of the plain data of an experiment, with undo and redo."""

    def __init__(self, document: T) -> None:
        self._past: list[T] = []
        self._future: list[T] = []
        self.document = document

    def __copy__(self) -> UndoHistory[T]:
        """Return an independent history of the same documents."""
        history = UndoHistory(self.document)
        history._past, history._future = list(self._past), list(self._future)
        return history

    @property
    def documents(self) -> tuple[T, ...]:
        """All stored documents: the past ones, the present one, and those that were undone."""
        return (*self._past, self.document, *self._future)

    @property
    def depth(self) -> int:
        """Number of changes that can be undone."""
        return len(self._past)

    def commit(self, document: T) -> None:
        """Add a new document; documents that were undone are discarded."""
        if document is self.document:
            return
        _leave(self.document)
        self._past.append(self.document)
        self._future.clear()
        self.document = document

    def amend(self, document: T) -> bool:
        """Replace the present document by a new one without a new step of the history.

        For a change that is made in many small ones. A change that ends where it began is no step: return
        whether there is one.
        """
        self._future.clear()
        if self._past and document == self._past[-1]:
            self.document = self._past.pop()
            return False
        self.document = document
        return True

    def change_all(self, edited: Callable[[T], T]) -> None:
        """Apply a function to all documents, also those that were undone."""
        self._past = [edited(doc) for doc in self._past]
        self._future = [edited(doc) for doc in self._future]
        self.document = edited(self.document)

    @property
    def ahead(self) -> int:
        """Number of changes that were undone and can be redone."""
        return len(self._future)

    def undo(self) -> bool:
        """Return to the previous document; False if it does not exist."""
        if not self._past:
            return False
        _leave(self.document)
        self._future.append(self.document)
        self.document = self._past.pop()
        return True

    def redo(self) -> bool:
        """Redo the last change that was undone; False if no change was undone."""
        if not self._future:
            return False
        self._past.append(self.document)
        self.document = self._future.pop()
        return True


def _leave(document: object) -> None:
    """Let a document of the past forget what it computed about itself."""
    if isinstance(document, Document):
        document.forget()


def _with_axes(part: Any, new: Mapping[Axis, Axis]) -> Any:
    """Return a part with other axes in the place of some; the same object if it has none of these."""
    moved: dict[str, Any] = {}
    for p in parameters(type(part)):
        value: Any = getattr(part, p.name) if p.form in ("axes", "axis", "part", "parts") else None
        if value is None:
            continue
        match p.form:
            case "axis":
                after: Any = new.get(value, value)
            case "axes":
                after = tuple(new.get(a, a) for a in value)
            case "part":
                after = _with_axes(value, new)
            case _:
                after = tuple(_with_axes(v, new) for v in value)
        same = after is value or (
            isinstance(after, tuple) and all(a is b for a, b in zip(after, value, strict=True))
        )
        moved |= {} if same else {p.name: after}
    return dc.replace(part, **moved) if moved else part


def _put(doc: Document, ident: str, path: str, value: Any) -> Document:
    entry = doc.by_id()[ident]
    try:
        new = replace(entry.element, path, value)
    except (ParameterError, UnknownName) as error:
        problem = error.problems[0]
        raise type(error)(problem.what, where=f"{entry.path}.{path}", fix=problem.fix) from None
    return dc.replace(
        doc, entries=tuple(dc.replace(e, element=new) if e.id == ident else e for e in doc.entries)
    )


def _vacant(
    doc: Document,
    names: PathNames,
    taken: Mapping[PathNames, Entry] | None = None,
    groups: Collection[PathNames] | None = None,
) -> None:
    """Refuse a path that is the path of an element, group or document parameter, or that leads into an
    element.
    """
    taken, groups = doc.by_names() if taken is None else taken, doc.groups if groups is None else groups
    if any(not isinstance(n, str) or not n or not is_text(n) for n in names):
        raise ModelError(
            "elements and groups need names, not"
            f" {next(n for n in names if not isinstance(n, str) or not n or not is_text(n))!r}"
        )
    occupied = as_taken(names, taken)
    if occupied is not None:
        raise ModelError(
            f"there is already an element {taken[occupied].path!r}", fix="Give one of them another name"
        )
    if as_taken(names, groups) is not None:
        raise ModelError(f"there is already a group {display(names)!r}", fix="Give one of them another name")
    for k in range(1, len(names)):
        if names[:k] in taken:
            raise ModelError(
                f"{display(names[:k])!r} is an element, not a group, so it cannot contain elements"
            )
    if doc.parameters and display(names) in [k.name for k in doc.parameters]:
        raise ModelError(
            f"a document parameter is called {display(names)!r}", fix="Give one of them another name"
        )


def _is_taken(doc: Document, names: PathNames) -> bool:
    """Return whether a path is the path of an element, group or document parameter, or begins the name of a
    document parameter as those of its parameters do.
    """
    path = display(names)
    return (
        as_taken(names, doc.by_names()) is not None
        or as_taken(names, doc.groups) is not None
        or any(k.name == path or k.name.startswith(f"{path}.") for k in doc.parameters)
    )


def _unambiguous(doc: Document, names: PathNames, element: Element) -> None:
    """Refuse a path at which a parameter of the element would have the path of a document parameter."""
    path = display(names)
    for k in doc.parameters:
        if k.name.startswith(f"{path}.") and k.name[len(path) + 1 :] in [
            p.name for p in parameters(type(element))
        ]:
            raise ModelError(
                f"a document parameter is called {k.name!r}, like a parameter of {path}",
                fix="Give one of them another name",
            )


def require_id(ident: Any, taken: Collection[str]) -> None:
    """Raise unless an id is valid and free."""
    if not isinstance(ident, str) or len(ident) != 8 or any(c not in "0123456789abcdef" for c in ident):
        raise ParameterError(f"the id is {show(ident)}; expected eight hexadecimal digits")
    if ident in taken:
        raise ModelError(f"the id {ident} belongs to another element")


def link_group(doc: Document, group: PathNames, template: str, elements: Mapping[str, str]) -> Document:
    """Return a document in which an existing group is linked to a template.

    `elements` are paths in the document by the ids of the template's elements.
    """
    if group not in doc.groups:
        fix = did_you_mean(display(group), [display(g) for g in doc.groups])
        raise UnknownName(f"there is no group {display(group)!r}", fix=fix)
    pairs = tuple((ident, find.element(doc, path).id) for ident, path in elements.items())
    return dc.replace(doc, uses=(*doc.uses, Use(group, template, pairs)))


def require_ticks(every: Any, where: str) -> None:
    """Raise unless `every` is a valid step of an element in ticks."""
    if isinstance(every, bool) or not isinstance(every, int) or not 1 <= every <= MOST_TICKS:
        raise ParameterError(
            f"the step is {show(every)} ticks; expected a whole number from 1 to {MOST_TICKS}", where=where
        )


def _free(base: str, taken: Callable[[str], bool]) -> str:
    name, n = base, 1
    while taken(name):
        n += 1
        name = f"{base}{n}"
    return name


def _with_groups(groups: Iterable[PathNames], new: Iterable[PathNames]) -> tuple[PathNames, ...]:
    out = dict.fromkeys(groups)
    for g in new:
        out |= dict.fromkeys(g[:k] for k in range(1, len(g) + 1))
    return tuple(out)
