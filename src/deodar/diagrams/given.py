"""Layout of a graph whose items have given positions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from deodar.diagrams.graph import Graph, GroupPath
from deodar.diagrams.layout import FRAME, HEAD, LEFT, RIGHT, SPACING, Arrangement, ItemSize, Segment

GIVEN = 0.7
"""Points per unit of the positions in a document; the studio's boxes are larger than those of pictures."""


def placed(
    graph: Graph,
    boxes: Mapping[str, ItemSize],
    labels: Mapping[int, tuple[float, float]],
    names: Mapping[GroupPath, float],
) -> Arrangement:
    """Lay out a graph at the given positions.

    Connections then run straight from side to side, without avoiding boxes.
    """
    left, top = (min(graph.places[i.id][k] for i in graph.items) for k in (0, 1))
    found = Arrangement()
    for item in graph.items:
        x, y = graph.places[item.id]
        found.boxes[item.id] = ((x - left) * GIVEN, (y - top) * GIVEN)
    for group in sorted(graph.groups, key=len, reverse=True):
        corners = [
            (*found.boxes[i.id], boxes[i.id].width, boxes[i.id].height)
            for i in graph.items
            if i.group == group
        ]
        corners += [f for g, f in found.frames.items() if g[:-1] == group]
        if corners:
            x, y = min(c[0] for c in corners) - FRAME, min(c[1] for c in corners) - HEAD - FRAME / 2
            wide = max(max(c[0] + c[2] for c in corners) + FRAME - x, names[group])
            found.frames[group] = (x, y, wide, max(c[1] + c[3] for c in corners) + FRAME - y)
    ends: dict[tuple[str, str], list[int]] = defaultdict(list)
    for w, wire in enumerate(graph.wires):
        if wire.source == wire.target:
            continue
        a, b = (found.boxes[i][0] + boxes[i].width / 2 for i in (wire.source, wire.target))
        found.backwards[w] = a > b
        ends[wire.source, LEFT if a > b else RIGHT].append(w)
        ends[wire.target, RIGHT if a > b else LEFT].append(w)
    at: dict[tuple[str, int], Segment] = {}
    for (ident, side), wires in ends.items():
        box, (x, y) = boxes[ident], found.boxes[ident]
        wires.sort(key=lambda w, me=ident: (found.boxes[_other(graph, w, me)][1], w))
        step = min(SPACING, (box.body - 6) / max(1, len(wires) - 1))
        for k, w in enumerate(wires):
            edge = x if side == LEFT else x + box.width
            at[ident, w] = Segment(edge, edge, y + box.top + box.body / 2 + step * (k - (len(wires) - 1) / 2))
    for w, wire in enumerate(graph.wires):
        if wire.source != wire.target:
            a, b = at[wire.source, w], at[wire.target, w]
            found.runs[w] = [b, a] if found.backwards[w] else [a, b]
            if w in labels:
                found.captions[w] = ((a.x0 + b.x0) / 2, (a.y + b.y) / 2)
    return _to_origin(found, boxes, labels)


def _other(graph: Graph, w: int, ident: str) -> str:
    wire = graph.wires[w]
    return wire.target if wire.source == ident else wire.source


def _to_origin(
    found: Arrangement, boxes: Mapping[str, ItemSize], labels: Mapping[int, tuple[float, float]]
) -> Arrangement:
    """Return the arrangement, shifted so that no position is below 0."""
    areas = [(x, y, boxes[i].width, boxes[i].height) for i, (x, y) in found.boxes.items()] + list(
        found.frames.values()
    )
    areas += [
        (x - labels[w][0] / 2, y - labels[w][1] / 2, *labels[w]) for w, (x, y) in found.captions.items()
    ]
    x, y = min(a[0] for a in areas), min(a[1] for a in areas)
    moved = Arrangement(
        backwards=found.backwards,
        width=max(a[0] + a[2] for a in areas) - x,
        height=max(a[1] + a[3] for a in areas) - y,
    )
    moved.boxes = {i: (bx - x, by - y) for i, (bx, by) in found.boxes.items()}
    moved.frames = {g: (fx - x, fy - y, w, h) for g, (fx, fy, w, h) in found.frames.items()}
    moved.captions = {w: (cx - x, cy - y) for w, (cx, cy) in found.captions.items()}
    moved.runs = {w: [Segment(r.x0 - x, r.x1 - x, r.y - y) for r in runs] for w, runs in found.runs.items()}
    return moved
