"""Graph of a picture as plain data: items, wires, and frames around groups, which may be folded."""

from __future__ import annotations

import dataclasses as dc
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from deodar.numerics.axes import Axes
from deodar.numerics.signs import Sign

ItemForm = Literal["field", "node", "source", "sensor", "motor", "coupling", "missing", "group"]
GroupPath = tuple[str, ...]


@dataclass(frozen=True)
class Item:
    """One element, or a group that is drawn as one box.

    Attributes:
        id: its id, which wires name.
        form: its shape.
        name: its name.
        kind: its kind in words; empty if the form shows it.
        axes: the axes over which it is defined.
        recurrence: signs of its interactions with itself, drawn as loops.
        group: names of the groups around it.
        every: ticks of its own step.
        axes_shown: whether its axes are written; not if all connected items have the same axes.
    """

    id: str
    form: ItemForm
    name: str
    kind: str = ""
    axes: Axes = ()
    recurrence: tuple[Sign, ...] = ()
    group: GroupPath = ()
    every: int = 1
    axes_shown: bool = True


@dataclass(frozen=True)
class Wire:
    """One connection, with the couplings on it.

    Attributes:
        source, target: ids of items.
        source_port, target_port: names of the ports; empty for the default port.
        sign: "+", "-" or "±".
        captions: one line of text for each coupling on the way.
        delayed: whether it is read one step later.
    """

    source: str
    target: str
    source_port: str = ""
    target_port: str = ""
    sign: Sign = "+"
    captions: tuple[str, ...] = ()
    delayed: bool = False


@dataclass(frozen=True)
class Graph:
    """The graph of a picture.

    Attributes:
        name: title of the picture, for readers of the screen.
        groups: every group, with the name of the template that it stays linked to, or "".
        places: upper left corners of items that have a given place; used where all have one.
    """

    name: str
    items: tuple[Item, ...]
    wires: tuple[Wire, ...]
    groups: Mapping[GroupPath, str] = field(default_factory=dict[GroupPath, str])
    places: Mapping[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])


def fold(graph: Graph, depth: int) -> Graph:
    """Return the same architecture with fewer boxes.

    Connections inside a folded group are omitted. Several connections between the same two boxes become one,
    with their common sign or with both signs; its text is their number. Positions in the document are those
    of open groups, so the result has a new layout.

    Args:
        graph: the whole graph.
        depth: number of levels of groups that remain open; with 0 every group is one box.
    """
    folded = {item.id: item.group[: depth + 1] for item in graph.items if len(item.group) > depth}
    if not folded:
        return graph
    inside = Counter(folded.values())
    items: dict[str, Item] = {}
    for item in graph.items:
        group = folded.get(item.id)
        made = item if group is None else _box(group, inside[group], graph.groups[group])
        items.setdefault(made.id, made)
    found: dict[tuple[str, str], list[Wire]] = defaultdict(list)
    wires: list[Wire] = []
    for wire in graph.wires:
        groups = folded.get(wire.source), folded.get(wire.target)
        if groups == (None, None):
            wires.append(wire)
            continue
        source, target = (
            ident if group is None else _id(group)
            for ident, group in zip((wire.source, wire.target), groups, strict=True)
        )
        if source != target:
            ports = {
                "source_port": wire.source_port if groups[0] is None else "",
                "target_port": wire.target_port if groups[1] is None else "",
            }
            found[source, target].append(dc.replace(wire, source=source, target=target, **ports))
    wires += [_joined(several) for several in found.values()]
    open_groups = {g: template for g, template in graph.groups.items() if len(g) <= depth}
    return Graph(graph.name, tuple(items.values()), tuple(wires), open_groups)


def _id(group: GroupPath) -> str:
    return "group " + "\0".join(group)


def _box(group: GroupPath, inside: int, template: str) -> Item:
    kind = f"linked to {template}" if template else f"{inside} element{'s' if inside > 1 else ''}"
    return Item(_id(group), "group", group[-1], kind, group=group[:-1])


def _joined(wires: list[Wire]) -> Wire:
    first = wires[0]
    if len(wires) == 1:
        return first
    sign: Sign = first.sign if all(w.sign == first.sign for w in wires) else "±"
    ports = [
        p if len(set(p)) == 1 else ("",)
        for p in ([w.source_port for w in wires], [w.target_port for w in wires])
    ]
    return Wire(
        first.source,
        first.target,
        ports[0][0],
        ports[1][0],
        sign,
        (f"{len(wires)} connections",),
        all(w.delayed for w in wires),
    )
