"""The layout: nothing overlaps, connections avoid boxes, and text is inside its box."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import pytest

import deodar as dd
from deodar.diagrams import boxes, given, layers, layout, paint, text
from deodar.diagrams.graph import Graph, Item, Wire
from deodar.diagrams.layers import settle
from deodar.diagrams.scene import Shape, TextLine
from deodar.model.sketch import sketch

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.json"))
X = dd.Axis("x", 0, 100, 11)


def big(fields=40, couplings=150, seed=0):
    """Return a random architecture with groups and long names."""
    draw = random.Random(seed)
    model = dd.Model("big")
    handles = [
        model.add(
            dd.Field(f"field number {i} of many" if i % 5 else f"u{i}", [X] if i % 4 else []),
            group=f"group {i % 4}" if i % 3 else "",
        )
        for i in range(fields)
    ]
    for _ in range(couplings):
        a, b = draw.choice(handles), draw.choice(handles)
        a >> dd.Gain(draw.choice([-2.0, 1.5])) >> b
    return sketch(model.document)


def laid_out(graph):
    """Return the boxes (x, y, width, height), the layout, and the painted connections."""
    scene = paint.paint(graph, legend=False)
    drawn, routes = paint.lay_out(graph)[:2]
    return (
        scene,
        {i: (x, y, drawn[i].box.width, drawn[i].box.height) for i, (x, y) in routes.boxes.items()},
        routes,
    )


def apart(a, b):
    return (
        a[0] + a[2] <= b[0] + 0.01
        or b[0] + b[2] <= a[0] + 0.01
        or a[1] + a[3] <= b[1] + 0.01
        or b[1] + b[3] <= a[1] + 0.01
    )


def along(shape):
    """Return points on a path."""
    at, points = (0.0, 0.0), []
    for name, *numbers in shape.path:
        if name in "ML":
            x, y = numbers
            points += (
                [(at[0] + (x - at[0]) * k / 12, at[1] + (y - at[1]) * k / 12) for k in range(1, 13)]
                if name == "L"
                else [(x, y)]
            )
            at = (x, y)
        elif name == "C":
            a, b, c, d, x, y = numbers
            for k in range(1, 13):
                t = k / 12
                w = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
                points.append(
                    (
                        w[0] * at[0] + w[1] * a + w[2] * c + w[3] * x,
                        w[0] * at[1] + w[1] * b + w[2] * d + w[3] * y,
                    )
                )
            at = (x, y)
    return points


@pytest.mark.parametrize(
    "graph",
    [
        *(pytest.param(sketch(dd.load(p).document), id=p.stem) for p in EXAMPLES),
        pytest.param(big(), id="big"),
    ],
)
def test_boxes_do_not_overlap_and_connections_are_routed_around_them(graph):
    scene, places, routes = laid_out(graph)
    boxes_placed = list(places.items())
    for k, (place, a) in enumerate(boxes_placed):
        assert (
            a[0] >= -0.01
            and a[0] + a[2] <= routes.width + 0.01
            and a[1] >= -0.01
            and a[1] + a[3] <= routes.height + 0.01
        )
        for other, b in boxes_placed[k + 1 :]:
            assert apart(a, b), (place, other)
    group = {box.id: box.group for box in graph.items}
    for ident, (x, y, w, h) in boxes_placed:
        for g, (fx, fy, fw, fh) in routes.frames.items():
            inside = group[ident][: len(g)] == g
            assert (
                (fx < x and fy < y and x + w < fx + fw and y + h < fy + fh)
                if inside
                else apart((x, y, w, h), (fx, fy, fw, fh))
            ), (ident, g)
    wires = [w for w in graph.wires if w.source != w.target]
    lines = [part.content[0] for part in scene.parts if part.role == "wire"]
    assert len(lines) == len(wires)
    edge = paint.MARGIN
    for wire, line in zip(wires, lines, strict=True):
        for x, y in along(line):
            for ident, (bx, by, bw, bh) in boxes_placed:
                inside = bx + 0.5 < x - edge < bx + bw - 0.5 and by + 0.5 < y - edge < by + bh - 0.5
                assert not inside or ident in (wire.source, wire.target), (wire, ident)


def test_captions_do_not_overlap_boxes_or_each_other():
    for graph in (big(20, 60), sketch(dd.load(EXAMPLES[0]).document)):
        drawn, routes, sizes = paint.lay_out(graph)
        rects = [(x, y, drawn[i].box.width, drawn[i].box.height) for i, (x, y) in routes.boxes.items()]
        rects += [
            (x - sizes[w][0] / 2, y - sizes[w][1] / 2, *sizes[w]) for w, (x, y) in routes.captions.items()
        ]
        assert len(routes.captions) > 10
        assert all(apart(a, b) for k, a in enumerate(rects) for b in rects[k + 1 :])


@pytest.mark.parametrize("form", ["field", "node", "source", "sensor", "motor", "coupling", "missing"])
@pytest.mark.parametrize(
    "name",
    [
        "u",
        "a name of many words that continues and continues",
        "oneverylongwordwithoutanyplacetobreakitatall",
        "名前はとても長いですから折り返す",
        "",
    ],
)
def test_text_is_inside_its_box(form, name):
    box = Item("a", form, name, "kind of a thing", (X, dd.Axis("y", -180, 180, 5, periodic=True, unit="deg")))
    drawn = boxes.prepare(box, ["gate"], ["activation"], [boxes.Loop("+", ("× 2",)), boxes.Loop("-")], 9)
    for element in boxes.paint(drawn, 0, 0):
        if isinstance(element, TextLine):
            half = text.width(element.text, element.size, element.bold) / 2
            assert (
                element.x - half >= -0.01
                and element.x + half <= drawn.box.width + 0.01
                and 0 < element.y <= drawn.box.height
            )
    heights = drawn.box.top, drawn.box.body
    assert heights[0] >= boxes.LOOP + boxes.SMALL_LINE and heights[1] >= 8 * boxes.CLOSEST


def test_given_positions_are_kept():
    graph = Graph(
        "g",
        (Item("a", "field", "a"), Item("b", "node", "b", group=("g",))),
        (Wire("b", "a", captions=("× 2",)), Wire("b", "a")),
        {("g",): ""},
        {"a": (300, 40), "b": (0, 0)},
    )
    drawn, routes, _ = paint.lay_out(graph)
    assert routes.boxes["a"][0] - routes.boxes["b"][0] == pytest.approx(300 * given.GIVEN)
    assert routes.boxes["a"][1] - routes.boxes["b"][1] == pytest.approx(40 * given.GIVEN)
    x, y, w, h = routes.frames["g",]
    assert (
        x < routes.boxes["b"][0]
        and x + w > routes.boxes["b"][0] + drawn["b"].box.width
        and y < routes.boxes["b"][1] < y + h
    )
    centre = routes.boxes["a"][1] + drawn["a"].box.top + drawn["a"].box.body / 2
    assert sum(routes.runs[w][-1].y for w in (0, 1)) / 2 == pytest.approx(centre)
    part = Graph("g", graph.items, graph.wires, graph.groups, {"a": (300, 40)})
    assert paint.lay_out(part)[1].boxes["a"][0] > paint.lay_out(part)[1].boxes["b"][0], (
        "laid out again where not all have a place"
    )


def test_the_order_of_columns_avoids_crossings():
    after = {"a": ["y"], "b": ["x"], "c": ["z"]}
    before = {"y": ["a"], "x": ["b"], "z": ["c"]}
    columns = [["a", "b", "c"], ["x", "y", "z"]]
    assert layers.crossings(columns, after | {"x": [], "y": [], "z": []}) == 1
    full = after | {"x": [], "y": [], "z": []}
    ordered = layers.order(columns, full, before | {"a": [], "b": [], "c": []})
    assert layers.crossings(ordered, full) == 0


def test_few_edges_run_backwards():
    place = layers.forward(list("abcd"), [("a", "b"), ("b", "c"), ("c", "a"), ("c", "d"), ("d", "d")])
    assert sum(place[x] > place[y] for x, y in [("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")]) == 1
    rank = layers.ranks(list("abcde"), [("a", "b"), ("b", "c"), ("d", "c"), ("a", "e")])
    assert rank == {"a": 0, "b": 1, "c": 2, "d": 1, "e": 1}, "what is read late stands late"


def test_positions_are_the_nearest_that_keep_order_and_distance():
    assert settle([0.0, 10.0, 30.0], [1, 1, 1], [5, 5]) == [0.0, 10.0, 30.0]
    assert settle([10.0, 10.0], [1, 1], [6]) == [7.0, 13.0]
    assert settle([10.0, 10.0], [1, 3], [4]) == [7.0, 11.0]


def test_text_is_broken_into_lines_and_cut():
    assert text.wrap("a b", 8, 100, 3) == ["a b"]
    lines = text.wrap("one two three four five six seven eight nine ten", 8, 50, 3)
    assert (
        len(lines) == 3 and lines[-1].endswith(text.CUT) and all(text.width(line, 8) <= 50 for line in lines)
    )
    assert "".join(text.wrap("abcdefghijklmnopqrstuvwxyz", 8, 40, 9)) == "abcdefghijklmnopqrstuvwxyz"
    assert text.wrap("line\nbreak\0 and \ud800", 8, 200, 3) == ["line break and"]


def test_marks_differ_in_shape_and_not_only_in_colour():
    shapes = {
        sign: [s for s in paint.wires.mark((10, 10), (1, 0), sign) if isinstance(s, Shape)]
        for sign in ("+", "-", "±")
    }
    kinds = {sign: [len(s.path) for s in shape] for sign, shape in shapes.items()}
    assert kinds == {"+": [4], "-": [6], "±": [4, 6]}


def test_a_caption_is_in_the_middle_of_a_segment_of_its_connection():
    graph = big(20, 60)
    _, routes, sizes = paint.lay_out(graph)
    assert (
        set(routes.captions)
        == set(sizes)
        == {k for k, w in enumerate(graph.wires) if w.captions and w.source != w.target}
    )
    for wire, (x, y) in routes.captions.items():
        half = sizes[wire][0] / 2
        assert any(
            run.y == pytest.approx(y) and run.x0 - 0.01 <= x - half and x + half <= run.x1 + 0.01
            for run in routes.runs[wire]
        ), (wire, x, y, routes.runs[wire])


def test_the_space_between_columns_grows_with_the_climb_of_connections():
    items = [Item(name, "field", name) for name in ("a", *(f"b{k}" for k in range(9)))]
    wires = [Wire("a", box.id) for box in items[1:]]
    fan = paint.lay_out(Graph("fan", tuple(items), tuple(wires), {}))[1]
    pair = paint.lay_out(Graph("pair", tuple(items[:2]), tuple(wires[:1]), {}))[1]
    spaces: dict[str, list[float]] = {}
    for name, routes in (("fan", fan), ("pair", pair)):
        steps = [step for runs in routes.runs.values() for step in itertools.pairwise(runs)]
        spaces[name] = [other.x0 - before.x1 for before, other in steps]
        # a space and the one after it, with the lanes of connections between them
        for (one, other), space in zip(steps, spaces[name], strict=True):
            assert space >= 2 * layout.GAP + layout.STEEPEST * abs(other.y - one.y) - 0.01
    assert min(spaces["fan"]) > max(spaces["pair"]) + 5


@pytest.mark.parametrize("count", [2, 3, 9])
@pytest.mark.parametrize("form", ["node", "field"])
def test_connections_at_one_side_share_the_height_of_a_box(form, count):
    items = [Item("end", form, "end"), *(Item(f"s{k}", "node", f"s{k}") for k in range(count))]
    graph = Graph("ends", tuple(items), tuple(Wire(i.id, "end") for i in items[1:]), {})
    drawn, routes, _ = paint.lay_out(graph)
    box, top = drawn["end"].box, routes.boxes["end"][1]
    ends = sorted(runs[-1].y for runs in routes.runs.values())
    steps = [b - a for a, b in itertools.pairwise(ends)]
    assert steps == pytest.approx([min(layout.SPACING, (box.body - 6) / (count - 1))] * (count - 1))
    assert min(steps) >= boxes.CLOSEST - 0.01
    assert (ends[0] + ends[-1]) / 2 == pytest.approx(top + box.top + box.body / 2)


def test_connections_pass_a_box_at_the_same_distance_above_and_below():
    draw, n = random.Random(1), 14
    items = tuple(Item(f"e{k}", "field", f"e{k}") for k in range(n))
    wires = [Wire(f"e{a}", f"e{b}") for a in range(n) for b in range(a + 1, n) if draw.random() < 0.35]
    drawn, routes, _ = paint.lay_out(Graph("lanes", items, tuple(wires), {}))
    above, below, boxes_apart = [], [], []
    for ident, (x, y) in routes.boxes.items():
        width, height = drawn[ident].box.width, drawn[ident].box.height
        passing = [
            r.y for runs in routes.runs.values() for r in runs if r.x0 <= x + 0.01 and r.x1 >= x + width
        ]
        above += [y - at for at in passing if at < y]
        below += [at - y - height for at in passing if at > y + height]
        beside = [
            (by, i) for i, (bx, by) in routes.boxes.items() if bx < x + width and x < bx + drawn[i].box.width
        ]
        boxes_apart += [by - y - height for by, i in beside if i != ident and by > y]
    assert len(above) > 10 and len(below) > 10
    assert min(above) == pytest.approx(min(below)) == pytest.approx(layout.APART[True, False])
    assert min(boxes_apart) >= layout.APART[True, True] - 0.01
