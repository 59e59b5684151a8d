"""A graph with groups folded: each group below a depth is one box, and connections between the same two boxes
are one connection.
"""

from __future__ import annotations

import dataclasses as dc
from collections import Counter, defaultdict

from deodar.diagrams.graph import Graph, GroupPath, Item, Wire
from deodar.numerics.signs import Sign


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
