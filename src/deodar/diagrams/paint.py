"""Painting of a graph as a scene."""

from __future__ import annotations

import dataclasses as dc
from collections import defaultdict

from deodar.diagrams import boxes, given, layout, wires
from deodar.diagrams import text as texts
from deodar.diagrams.boxes import INK, NAME, PORT, SMALL, SMALL_LINE, SOFT, Loop, SizedItem
from deodar.diagrams.graph import Graph, GroupPath, Wire
from deodar.diagrams.layout import Arrangement, Segment
from deodar.diagrams.scene import Drawing, SceneItem, Shape, TextLine, rectangle
from deodar.numerics.signs import Sign

MARGIN = 6.0
CAPTION = 70.0
"""Width above which text on a connection is broken into lines."""

WIDEST_NAME = 140.0
"""Width at which the name of a group is cut."""

MOST_LINES = 4
LEGEND: dict[Sign, str] = {"+": "excitation", "-": "inhibition", "±": "both"}


def paint(graph: Graph, legend: bool = True) -> Drawing:
    """Lay a graph out and paint it: frames at the back, then connections and their text, then items."""
    drawn, found, sizes = lay_out(graph)
    ends = [w for w, wire in enumerate(graph.wires) if wire.source != wire.target]
    parts = [*_frames(graph, found), *(_wire(graph, w, found, drawn) for w in ends)]
    parts += [
        _chip(caption(graph.wires[w]), found.captions[w], sizes[w], graph.wires[w].sign)
        for w in ends
        if w in found.captions
    ]
    parts += [_item(one, *found.boxes[ident]) for ident, one in drawn.items()]
    scene = Drawing(found.width, found.height, graph.name, parts)
    if legend:
        _legend(scene, graph)
    return _framed(scene)


def lay_out(graph: Graph) -> tuple[dict[str, SizedItem], Arrangement, dict[int, tuple[float, float]]]:
    """Return every item with its size, all positions, and the size of the text on each connection that has
    one.
    """
    sides: dict[tuple[str, str], list[str]] = defaultdict(list)
    counts: dict[str, int] = defaultdict(int)
    loops: dict[str, list[Loop]] = {item.id: [Loop(sign) for sign in item.recurrence] for item in graph.items}
    sizes: dict[int, tuple[float, float]] = {}
    for w, wire in enumerate(graph.wires):
        lines = caption(wire)
        if wire.source == wire.target:
            loops[wire.source].append(Loop(wire.sign, lines, wire.delayed))
            continue
        for ident, side, port in (
            (wire.source, "out", wire.source_port),
            (wire.target, "in", wire.target_port),
        ):
            counts[ident] += 1
            sides[ident, side] += [port] if port else []
        if lines:
            sizes[w] = texts.widest(lines, SMALL) + 5, SMALL_LINE * len(lines) + 2.5
    drawn = {
        item.id: boxes.prepare(
            item, sides[item.id, "in"], sides[item.id, "out"], loops[item.id], counts[item.id]
        )
        for item in graph.items
    }
    names = {g: texts.width(_name(graph, g), NAME) + 14 for g in graph.groups}
    placed = graph.items and all(item.id in graph.places for item in graph.items)
    arrange = given.placed if placed else layout.arrange
    return drawn, arrange(graph, {i: d.box for i, d in drawn.items()}, sizes, names), sizes


def caption(wire: Wire) -> tuple[str, ...]:
    """Return the lines of text on a connection: one or more for each coupling."""
    lines = [line for one in wire.captions for line in texts.wrap(one, SMALL, CAPTION, 2)]
    if len(lines) > MOST_LINES:
        lines = [*lines[: MOST_LINES - 1], f"{lines[MOST_LINES - 1]} {texts.CUT}"]
    return tuple(lines)


# ------------------------------------------------------------------------------------------------------ parts


def _frames(graph: Graph, found: Arrangement) -> list[SceneItem]:
    out: list[SceneItem] = []
    for group in sorted(found.frames, key=len):
        x, y, w, h = found.frames[group]
        template = graph.groups[group]
        fill = "#f6f6f6" if len(group) % 2 else "#ececec"
        frame = Shape(rectangle(x, y, w, h, 5.0), "#9a9a9a", fill, 0.7, (3.0, 2.0) if template else ())
        name = _name(graph, group)
        out.append(
            SceneItem(
                "group",
                " / ".join(group),
                [frame, TextLine(name, x + 6, y + 9.5, NAME, "start", color=SOFT, italic=True)],
            )
        )
    return out


def _name(graph: Graph, group: GroupPath) -> str:
    template = graph.groups[group]
    [name] = texts.wrap(group[-1] + (f" (linked to {template})" if template else ""), NAME, WIDEST_NAME, 1)
    return name


def _item(one: SizedItem, x: float, y: float) -> SceneItem:
    item, box = one.item, one.box
    part = SceneItem(item.form, item.name + (f" ({item.kind})" if item.kind else ""), boxes.paint(one, x, y))
    total = sum(loop.width for loop in one.loops)
    at, top = x + box.width / 2 - total / 2, y + box.top
    room = box.body / 2 * 0.85 if item.form == "node" else box.width / 2 - 3
    for loop in one.loops:
        middle = at + loop.width / 2
        shift = (
            max(-room + 5, min(room - 5, middle - x - box.width / 2))
            if item.form == "node"
            else middle - x - box.width / 2
        )
        left, right = x + box.width / 2 + shift - 5, x + box.width / 2 + shift + 5
        base = top + max(
            boxes.height_at(one, left - x - box.width / 2), boxes.height_at(one, right - x - box.width / 2)
        )
        part.content += wires.loop(left, base, right, boxes.LOOP - 2 + base - top, loop.sign, loop.delayed)
        for k, caption_ in enumerate(reversed(loop.captions)):
            part.content.append(
                TextLine(
                    caption_,
                    middle,
                    top - boxes.LOOP - 0.5 - k * SMALL_LINE,
                    SMALL,
                    color=wires.COLORS[loop.sign],
                )
            )
        at += loop.width
    return part


def _wire(graph: Graph, w: int, found: Arrangement, drawn: dict[str, SizedItem]) -> SceneItem:
    wire, runs, backwards = graph.wires[w], list(found.runs[w]), found.backwards[w]
    left, right = (wire.target, wire.source) if backwards else (wire.source, wire.target)
    for k, ident in ((0, left), (-1, right)):
        one, run = drawn[ident], runs[k]
        inset = boxes.reach(one, run.y - found.boxes[ident][1] - one.box.top - one.box.body / 2)
        if one.item.form == "sensor":
            inset = inset if k == 0 else 6.0 - inset
        runs[k] = Segment(run.x0 - inset, run.x1, run.y) if k == 0 else Segment(run.x0, run.x1 + inset, run.y)
    content: list[Shape | TextLine] = []
    content += wires.path(runs, backwards, wire.sign, wire.delayed)
    for port, at_left in ((wire.source_port, not backwards), (wire.target_port, backwards)):
        if port:
            run = runs[0] if at_left else runs[-1]
            x = run.x0 - 3 if at_left else run.x1 + 3
            content.append(TextLine(port, x, run.y + 1.9, PORT, "end" if at_left else "start", color=SOFT))
    names = {item.id: item.name for item in graph.items}
    on = f" ({', '.join(wire.captions)})" if wire.captions else ""
    return SceneItem("wire", f"{names[wire.source]} → {names[wire.target]}{on}", content)


def _chip(
    lines: tuple[str, ...], at: tuple[float, float], size: tuple[float, float], sign: Sign
) -> SceneItem:
    (x, y), (w, h) = at, size
    content: list[Shape | TextLine] = [
        Shape(rectangle(x - w / 2, y - h / 2, w, h, 2.5), "#c8c8c8", "#ffffff", 0.5)
    ]
    for k, one in enumerate(lines):
        content.append(
            TextLine(
                one,
                x,
                y - h / 2 + 1.2 + SMALL_LINE * k + 5.4,
                SMALL,
                color=wires.COLORS[sign] if sign != "+" else INK,
            )
        )
    return SceneItem("coupling", "", content)


def _legend(scene: Drawing, graph: Graph) -> None:
    """Draw a legend of the marks that occur below the picture, if there are several."""
    signs = {wire.sign for wire in graph.wires}.union(*(item.recurrence for item in graph.items))
    if len(signs) < 2:
        return
    part, x, y = SceneItem("legend", "", []), 0.0, scene.height + 12
    for sign, meaning in LEGEND.items():
        if sign not in signs:
            continue
        content = wires.path([Segment(x, x + 20, y)], False, sign)
        part.content += [*content, TextLine(meaning, x + 24, y + 2.1, SMALL, "start", color=SOFT)]
        x += 24 + texts.width(meaning, SMALL) + 12
    scene.parts.append(part)
    scene.height += 18
    scene.width = max(scene.width, x - 12)


def _framed(scene: Drawing) -> Drawing:
    """Return the scene with a margin."""

    def moved(one: Shape | TextLine) -> Shape | TextLine:
        if isinstance(one, TextLine):
            return dc.replace(one, x=one.x + MARGIN, y=one.y + MARGIN)
        return dc.replace(one, path=tuple((m[0], *(float(v) + MARGIN for v in m[1:])) for m in one.path))

    parts = [SceneItem(p.role, p.title, [moved(one) for one in p.content]) for p in scene.parts]
    return Drawing(scene.width + 2 * MARGIN, scene.height + 2 * MARGIN, scene.title, parts)
