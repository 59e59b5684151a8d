"""Layout of a graph whose items have given positions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from deodar.diagrams.graph import Graph, GroupPath
from deodar.diagrams.layout import FRAME, HEAD, LEFT, RIGHT, SPACING, Arrangement, ItemSize, Segment

Area = tuple[float, float, float, float]
"""x and y of the upper left corner, width and height."""

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
    at = {item.id: graph.places[item.id] for item in graph.items}
    found = Arrangement(boxes={i: ((x - left) * GIVEN, (y - top) * GIVEN) for i, (x, y) in at.items()})
    for group in sorted(graph.groups, key=len, reverse=True):
        areas = [
            (*found.boxes[i.id], boxes[i.id].width, boxes[i.id].height)
            for i in graph.items
            if i.group == group
        ]
        areas += [frame for inner, frame in found.frames.items() if inner[:-1] == group]
        if areas:
            found.frames[group] = _frame(areas, names[group])
    wires = {
        w: (wire.source, wire.target) for w, wire in enumerate(graph.wires) if wire.source != wire.target
    }
    middle = {i: x + boxes[i].width / 2 for i, (x, _) in found.boxes.items()}
    found.backwards = {w: middle[source] > middle[target] for w, (source, target) in wires.items()}
    ends = _ends(found, wires, boxes)
    for w, (source, target) in wires.items():
        a, b = ends[source, w], ends[target, w]
        found.runs[w] = [b, a] if found.backwards[w] else [a, b]
        if w in labels:
            found.captions[w] = ((a.x0 + b.x0) / 2, (a.y + b.y) / 2)
    return _to_origin(found, boxes, labels)


def _frame(areas: Sequence[Area], name: float) -> Area:
    """Return the frame around areas, at least as wide as the name of its group."""
    x, y = min(a[0] for a in areas) - FRAME, min(a[1] for a in areas) - HEAD - FRAME / 2
    right, bottom = max(a[0] + a[2] for a in areas), max(a[1] + a[3] for a in areas)
    return x, y, max(right + FRAME - x, name), bottom + FRAME - y


def _ends(
    found: Arrangement, wires: Mapping[int, tuple[str, str]], boxes: Mapping[str, ItemSize]
) -> dict[tuple[str, int], Segment]:
    """Return where each wire meets its items, in the order of the items at the other ends."""
    sides: dict[tuple[str, str], list[tuple[float, int]]] = defaultdict(list)
    for w, (source, target) in wires.items():
        out, into = (LEFT, RIGHT) if found.backwards[w] else (RIGHT, LEFT)
        sides[source, out].append((found.boxes[target][1], w))
        sides[target, into].append((found.boxes[source][1], w))
    ends: dict[tuple[str, int], Segment] = {}
    for (ident, side), others in sides.items():
        box, (x, y) = boxes[ident], found.boxes[ident]
        step = min(SPACING, (box.body - 6) / max(1, len(others) - 1))
        edge = x if side == LEFT else x + box.width
        for k, (_, w) in enumerate(sorted(others)):
            middle = y + box.top + box.body / 2
            ends[ident, w] = Segment(edge, edge, middle + step * (k - (len(others) - 1) / 2))
    return ends


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
