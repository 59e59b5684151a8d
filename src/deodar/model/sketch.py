"""The graph of a document for drawing.

A coupling with one connection in and one out becomes text on a connection.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence

from deodar.diagrams.boxes import number
from deodar.diagrams.graph import Graph, GroupPath, Item, ItemForm, Wire
from deodar.element import Coupling, Element
from deodar.elements.placeholder import Placeholder
from deodar.elements.world_ports import Motor, Sensor
from deodar.model import edit, find
from deodar.model.building import positions
from deodar.model.document import Connection, Document, Entry
from deodar.model.document_graph import graph
from deodar.numerics.axes import Axes
from deodar.numerics.signs import Sign, product
from deodar.parameters import Part, parameters


def sketch(doc: Document) -> Graph:
    """Return the graph of a document; if it has problems, of its valid part."""
    return _Sketch(doc).run()


def form_of(element: Element) -> ItemForm:
    """Return the shape of an element in the drawing."""
    if isinstance(element, Sensor):
        return "sensor"
    if isinstance(element, Motor):
        return "motor"
    if isinstance(element, Placeholder):
        return "missing"
    if is_coupling(element):
        return "coupling"
    if not element.ports():
        return "source"
    return "field" if getattr(element, "axes", ()) else "node"


def is_coupling(element: Element) -> bool:
    """Return whether an element is a coupling, which connects elements."""
    return isinstance(element, Coupling) or type(element).__module__.startswith("deodar.couplings.")


def effect(element: Element) -> Sign:
    """Return the sign that an element gives to its connections: couplings and sources weight what they send,
    fields and nodes do not.
    """
    return element.polarity() if form_of(element) in ("coupling", "source") else "+"


def caption(element: Element) -> str:
    """Return a short text of a coupling: its kind, and its characteristic number."""
    number = _main(element)
    if element.scaled_by:
        return f"× {number}"
    if element.kernels():
        return number
    return f"{title(element)} {number}".strip()


def title(element: Part) -> str:
    """Return the kind of an element, or of a part of it, in words."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", type(element).__name__).lower()


def _main(element: Element) -> str:
    for p in parameters(type(element)):
        value = getattr(element, p.name)
        if p.name == "kernel" and isinstance(value, tuple):
            return ", ".join(dict.fromkeys(f"{title(k)} kernel" for k in element.kernels()))
        if p.choices and isinstance(value, str) and p.name == "reduce":
            return value
        if p.form in ("number", "per_axis") and value is not None and p.name != "name":
            numbers = value if isinstance(value, tuple) else (value,)
            return ", ".join(number(float(v)) for v in numbers)
    return ""


class _Sketch:
    def __init__(self, doc: Document) -> None:
        self.doc = doc
        self.by: Mapping[str, Entry] = doc.by_id()
        connections = [c for c in doc.connections if c.source in self.by and c.target in self.by]
        self.into: dict[str, list[Connection]] = defaultdict(list)
        self.out: dict[str, list[Connection]] = defaultdict(list)
        for c in connections:
            self.into[c.target].append(c)
            self.out[c.source].append(c)
        self.connections = connections

    def run(self) -> Graph:
        axes = {node.id: node.outs for node in graph(self.doc).nodes}
        chained = self._chained()
        wires = [w for c in self.connections if c.source not in chained for w in [self._wire(c, chained)]]
        passed = {e for c in self.connections if c.source not in chained for e in self._follow(c, chained)[1]}
        # rings of couplings alone
        wires += [
            self._wire(c, set()) for c in self.connections if c.source in chained and c.source not in passed
        ]
        items = [self._item(e, axes.get(e.id, {})) for e in self.doc.entries if e.id not in passed]
        axes_of = {box.id: box.axes for box in items}
        differ = {w.source for w in wires if axes_of[w.target] != axes_of[w.source]}
        items = tuple(dc.replace(i, axes_shown=i.form != "source" or i.id in differ) for i in items)
        places = {i: place for i, place in positions(self.doc).items() if i in self.by}
        return Graph(self.doc.name, items, tuple(wires), self._groups(items), places)

    def _groups(self, items: Sequence[Item]) -> dict[GroupPath, str]:
        groups = {g: "" for g in self.doc.groups} | {use.group: use.template for use in self.doc.uses}
        for box in items:
            for k in range(1, len(box.group) + 1):
                groups.setdefault(box.group[:k], "")
        return dict(sorted(groups.items()))

    def _item(self, entry: Entry, outs: Mapping[str, Axes]) -> Item:
        element = entry.element
        form = form_of(element)
        axes = tuple(getattr(element, "axes", ()) or next(iter(outs.values()), ()))
        plain = type(element).__name__ == "Field" or form in ("source", "sensor", "motor")
        kind = "" if plain else caption(element) if form == "coupling" else title(element)
        name = entry.names[-1]
        if form == "coupling" and edit.is_unnamed(name, element):
            name, kind = kind, ""  # a name made from the connection adds no information to the kind
        recurrence = tuple(element.recurrence().values())
        drawn = axes if form != "coupling" else ()
        return Item(
            entry.id,
            form,
            name,
            kind,
            drawn,
            recurrence,
            entry.group,
            entry.every if element.stateful else 1,
        )

    def _chained(self) -> set[str]:
        """Return the couplings that are drawn on a connection: one in, one out."""
        return {
            e.id
            for e in self.doc.entries
            if is_coupling(e.element)
            and len(self.into[e.id]) == len(self.out[e.id]) == 1
            and len(e.element.ports()) == 1
            and len(find.outputs(e)) == 1
            and self.into[e.id][0].source != e.id
        }

    def _follow(self, first: Connection, chained: set[str]) -> tuple[Connection, list[str]]:
        last, on = first, list[str]()
        while last.target in chained and last.target not in on:
            on.append(last.target)
            [last] = self.out[last.target]
        return last, on

    def _wire(self, first: Connection, chained: set[str]) -> Wire:
        last, on = self._follow(first, chained)
        source, target = self.by[first.source], self.by[last.target]
        form, numbers = form_of(source.element), form_of(target.element) == "coupling" and not on
        # an input of a coupling is a number, which inhibits no field
        sign: Sign = "+" if form == "source" and numbers else effect(source.element)
        for ident in on:
            sign = product(sign, self.by[ident].element.polarity())
        reads = [c.reads for c in (first, last)] + [self.out[i][0].reads for i in on]
        source_port = "" if first.source_port == find.outputs(source)[0] else first.source_port
        target_port = (
            ""
            if not target.element.ports() or last.target_port == target.element.ports()[0]
            else last.target_port
        )
        captions = tuple(caption(self.by[ident].element) for ident in on)
        return Wire(source.id, target.id, source_port, target_port, sign, captions, "delayed" in reads)
