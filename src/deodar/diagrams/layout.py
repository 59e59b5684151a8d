"""Layout of groups from inside out, each as a block in the group around it, with a lane in each column for
every connection that passes.

Connections run through lanes of their own and through the spaces between columns, so that none runs through a
box.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from deodar.diagrams import layers
from deodar.diagrams.graph import Graph, GroupPath
from deodar.diagrams.layers import settle

ROUNDS = 24
LEFT, RIGHT = "left", "right"

GAP = 13.0
"""Space between two columns; between elements lie two spaces and the lane of the label."""

STEEPEST = 0.09
"""Share of the longest climb of a connection by which the space between columns grows."""

WIDEST_GAP = 42.0
APART = {(True, True): 13.0, (True, False): 8.0, (False, True): 8.0, (False, False): 6.5}
"""Smallest distances between neighbours of a column: boxes, and lanes."""

FRAME = 9.0
HEAD = 13.0
"""Space inside a frame, and the space above it for its name."""

SPACING = 9.0
"""Distance of connections at one side of a box that is high enough."""


@dataclass
class ItemSize:
    """Size of an item.

    Attributes:
        width, height: of the whole.
        top: distance from the upper edge to the part where connections end.
        body: height of that part.
    """

    width: float
    height: float
    top: float
    body: float


@dataclass(frozen=True)
class Segment:
    """A horizontal segment of a connection, from left to right."""

    x0: float
    x1: float
    y: float


@dataclass
class Arrangement:
    """Positions of all items, groups and connections.

    Attributes:
        boxes: upper left corner of each item.
        frames: x, y, width and height of each group.
        runs: horizontal segments of each wire from left to right; empty for one that ends where it begins.
        backwards: whether the target of each wire is at its left.
        captions: middle of the text of each wire that has one.
    """

    boxes: dict[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
    frames: dict[GroupPath, tuple[float, float, float, float]] = field(
        default_factory=dict[GroupPath, tuple[float, float, float, float]]
    )
    runs: dict[int, list[Segment]] = field(default_factory=dict[int, list[Segment]])
    backwards: dict[int, bool] = field(default_factory=dict[int, bool])
    captions: dict[int, tuple[float, float]] = field(default_factory=dict[int, tuple[float, float]])
    width: float = 0.0
    height: float = 0.0


@dataclass
class _Block:
    """An item, or a group that is laid out with its corner at the origin."""

    box: ItemSize
    inside: Arrangement | None = None
    ports: dict[int, float] = field(default_factory=dict[int, float])


@dataclass(frozen=True)
class _Edge:
    """An edge inside a group: names of its left and right ends, and the wire."""

    left: str
    right: str
    wire: int


def arrange(
    graph: Graph,
    boxes: Mapping[str, ItemSize],
    labels: Mapping[int, tuple[float, float]],
    names: Mapping[GroupPath, float],
) -> Arrangement:
    """Lay out a graph.

    Args:
        graph: the graph to lay out.
        boxes: size of each item.
        labels: width and height of the text on each wire that has one.
        names: width of the name of each group.
    """
    return _Arranger(graph, boxes, labels, names).run()


class _Arranger:
    def __init__(
        self,
        graph: Graph,
        boxes: Mapping[str, ItemSize],
        labels: Mapping[int, tuple[float, float]],
        names: Mapping[GroupPath, float],
    ) -> None:
        self.graph, self.boxes, self.labels, self.names = graph, boxes, labels, names
        self.group = {item.id: item.group for item in graph.items}
        self.children: dict[GroupPath, list[str | GroupPath]] = {g: [] for g in [(), *graph.groups]}
        for item in graph.items:
            self.children[item.group].append(item.id)
        for g in graph.groups:
            self.children[g[:-1]].append(g)
        self.sides: dict[tuple[int, GroupPath], str] = {}
        self.edges: dict[GroupPath, list[_Edge]] = defaultdict(list)
        self.home: dict[int, GroupPath] = {}
        self.backwards: dict[int, bool] = {}
        self.rank: dict[GroupPath, dict[str, int]] = {}

    def run(self) -> Arrangement:
        self._orient(())
        block = self._block(())
        assert block.inside is not None
        found = block.inside
        found.backwards = self.backwards
        return found

    # ------------------------------------------------------------------- from outside in: which way wires run

    def _child(self, ident: str, level: GroupPath) -> str | GroupPath | None:
        """Return the child of a group that contains an item; None if the item is outside."""
        group = self.group[ident]
        if group[: len(level)] != level:
            return None
        return ident if len(group) == len(level) else group[: len(level) + 1]

    def _orient(self, level: GroupPath) -> None:
        """Decide from which side each wire meets the groups on this level, and rank the children by it."""
        nodes = [_key(c) for c in self.children[level]]
        ends = [(self._child(w.source, level), self._child(w.target, level)) for w in self.graph.wires]
        edges = [
            self._crossing(w, a if b is None else b, level)
            for w, (a, b) in enumerate(ends)
            if (a is None) != (b is None)
        ]
        inner = [(w, a, b) for w, (a, b) in enumerate(ends) if a is not None and b is not None and a != b]
        place = layers.forward(nodes, [(_key(a), _key(b)) for _, a, b in inner])
        for w, a, b in inner:
            self.home[w] = level
            self.backwards[w] = place[_key(a)] > place[_key(b)]
            left, right = (b, a) if self.backwards[w] else (a, b)
            edges.append(_Edge(_key(left), _key(right), w))
            self._meet(left, w, RIGHT)
            self._meet(right, w, LEFT)
        real = [(e.left, e.right) for e in edges if e.left in place and e.right in place]
        self.rank[level] = layers.ranks(sorted(nodes, key=lambda n: place[n]), real)
        self.edges[level] = edges
        for child in self.children[level]:
            if not isinstance(child, str):
                self._orient(child)

    def _crossing(self, w: int, inside: str | GroupPath | None, level: GroupPath) -> _Edge:
        """Return the edge of a wire that crosses the border of a group."""
        assert inside is not None
        side = self.sides[w, level]
        self._meet(inside, w, side)
        return _Edge(_port(w), _key(inside), w) if side == LEFT else _Edge(_key(inside), _port(w), w)

    def _meet(self, child: str | GroupPath, w: int, side: str) -> None:
        if not isinstance(child, str):
            self.sides[w, child] = side

    # --------------------------------------------------------------- from inside out: where everything stands

    def _block(self, level: GroupPath) -> _Block:
        children = {_key(c): c for c in self.children[level]}
        blocks = {
            k: _Block(self.boxes[c]) if isinstance(c, str) else self._block(c) for k, c in children.items()
        }
        made = _Level(
            level,
            blocks,
            self.rank[level],
            self.edges[level],
            self.labels,
            self.home,
            self.names.get(level, 0.0),
        )
        found = made.run()
        for key, block in blocks.items():
            x, y = made.corners[key]
            child = children[key]
            if isinstance(child, str):
                found.boxes[child] = (x, y)
            else:
                _move_into(found, block, child, x, y)
        return _Block(ItemSize(found.width, found.height, 0.0, found.height), found, made.ports)


@dataclass(frozen=True)
class _Columns:
    """Left edge and width of each column of a group, and the right edge of the group."""

    lefts: Sequence[float]
    widths: Sequence[float]
    right: float

    def middle(self, column: int, width: float) -> float:
        """Return the left edge of a box of this width in the middle of a column."""
        return self.lefts[column] + (self.widths[column] - width) / 2


class _Level:
    """Lay out one group: its children in columns."""

    def __init__(
        self, level: GroupPath, blocks: dict[str, _Block], rank: dict[str, int], edges: list[_Edge],
        labels: Mapping[int, tuple[float, float]], home: Mapping[int, GroupPath], least: float,
    ) -> None:  # fmt: skip
        self.level, self.blocks, self.edges, self.least = level, blocks, edges, least
        self.margin = FRAME if level else 0.0
        self.labels = {w: size for w, size in labels.items() if home.get(w) == level}
        low = min(rank.values(), default=0)
        self.column = {n: 2 * (r - low) + 1 for n, r in rank.items()}
        self.last = max(self.column.values(), default=1) + 1
        for e in edges:
            for name, column in ((e.left, 0), (e.right, self.last)):
                if name not in blocks:
                    self.column[name] = column
        self.size: dict[str, tuple[float, float]] = {
            n: (b.box.width, b.box.height) for n, b in blocks.items()
        }
        self.path: dict[int, list[str]] = {}
        self.carries: dict[str, int] = {}
        self.links: dict[str, list[str]] = defaultdict(list)
        self.back: dict[str, list[str]] = defaultdict(list)
        self.offset: dict[tuple[str, int], float] = {}
        self.corners: dict[str, tuple[float, float]] = {}
        self.ports: dict[int, float] = {}

    def run(self) -> Arrangement:
        columns = self._lanes()
        columns = layers.order(columns, self.links, self.back)
        self._attach(columns)
        y = self._heights(columns)
        return self._places(columns, y)

    def _lanes(self) -> list[list[str]]:
        """Return the columns, with a lane for each wire in each column that it passes; the middle lane
        between boxes has its text.
        """
        columns: list[list[str]] = [[] for _ in range(self.last + 1)]
        for n in self.blocks:
            columns[self.column[n]].append(n)
        for e in self.edges:
            a, b = self.column[e.left], self.column[e.right]
            path = [e.left]
            between = [c for c in range(a + 1, b) if c % 2 == 0]
            middle = min(between, key=lambda c: (abs(c - (a + b) / 2), c)) if between else None
            for c in range(a + 1, b):
                lane = f"lane {e.wire} {c}"
                columns[c].append(lane)
                self.column[lane] = c
                self.carries[lane] = e.wire
                self.size[lane] = self.labels.get(e.wire, (0.0, 0.0)) if c == middle else (0.0, 0.0)
                path.append(lane)
            path.append(e.right)
            for end in (e.left, e.right):
                if end not in self.blocks:
                    columns[self.column[end]].append(end)
                    self.carries[end] = e.wire
                    self.size[end] = (0.0, 0.0)
            self.path[e.wire] = path
            for one, other in itertools.pairwise(path):
                self.links[one].append(other)
                self.back[other].append(one)
        return columns

    def _attach(self, columns: Sequence[Sequence[str]]) -> None:
        """Return the distance of the end of each wire from the upper edge of a block, in the order of the
        other ends.
        """
        at = {n: k for column in columns for k, n in enumerate(column)}
        for side, end, near in ((LEFT, -1, -2), (RIGHT, 0, 1)):
            found: dict[str, list[int]] = defaultdict(list)
            for w, path in self.path.items():
                if path[end] in self.blocks:
                    found[path[end]].append(w)
            for n, wires in found.items():
                block = self.blocks[n]
                if block.inside is not None:
                    for w in wires:
                        self.offset[n + side, w] = block.ports[w]
                    continue
                wires.sort(key=lambda w, near=near: (at[self.path[w][near]], w))
                room = block.box.body - 6
                step = min(SPACING, room / max(1, len(wires) - 1))
                first = block.box.top + block.box.body / 2 - step * (len(wires) - 1) / 2
                for k, w in enumerate(wires):
                    self.offset[n + side, w] = first + k * step

    def _heights(self, columns: Sequence[Sequence[str]]) -> dict[str, float]:
        """Return the upper edge of every node and lane."""
        y: dict[str, float] = {}
        gaps: list[list[float]] = []
        for column in columns:
            gaps.append(
                [
                    self.size[a][1] + APART[a in self.blocks, b in self.blocks]
                    for a, b in itertools.pairwise(column)
                ]
            )
            total = sum(gaps[-1]) + (self.size[column[-1]][1] if column else 0.0)
            at = -total / 2
            for n, gap in zip(column, [*gaps[-1], 0.0], strict=False):
                y[n] = at
                at += gap
        pulls = self._pulls()
        for turn in range(ROUNDS):
            for c in range(len(columns)) if turn % 2 == 0 else range(len(columns) - 1, -1, -1):
                requests, weights = list[float](), list[float]()
                for n in columns[c]:
                    total = sum(w for _, _, w in pulls[n])
                    requests.append(sum((y[m] + by) * w for m, by, w in pulls[n]) / total if total else y[n])
                    weights.append(total or 0.01)
                for n, at in zip(columns[c], settle(requests, weights, gaps[c]), strict=True):
                    y[n] = at
        return y

    def _pulls(self) -> dict[str, list[tuple[str, float, float]]]:
        """Return for each node its alignments: (other node, difference of the upper edges when aligned,
        weight).
        """
        pulls: dict[str, list[tuple[str, float, float]]] = defaultdict(list)
        for w, path in self.path.items():
            for a, b in itertools.pairwise(path):
                by = self._end(a, RIGHT, w) - self._end(b, LEFT, w)
                weight = {0: 6.0, 1: 2.0, 2: 1.0}[(a in self.blocks) + (b in self.blocks)]
                pulls[b].append((a, by, weight))
                pulls[a].append((b, -by, weight))
        return pulls

    def _end(self, n: str, side: str, w: int) -> float:
        return self.offset[n + side, w] if n in self.blocks else self.size[n][1] / 2

    def _places(self, columns: Sequence[Sequence[str]], y: Mapping[str, float]) -> Arrangement:
        across = self._across(columns, y)
        low = min(y.values(), default=0.0)
        bottom = max((at + self.size[n][1] for n, at in y.items()), default=0.0)
        down = (HEAD + FRAME * 0.5 if self.level else 0.0) - low
        found = Arrangement(width=across.right, height=bottom + down + self.margin)
        place = {n: (across.middle(self.column[n], self.size[n][0]), at + down) for n, at in y.items()}
        self.corners = {n: place[n] for n in self.blocks}
        self.ports = {self.carries[n]: place[n][1] for n in (*columns[0], *columns[-1])}
        found.runs = {w: self._runs(w, path, place, across) for w, path in self.path.items()}
        for lane, w in self.carries.items():
            (x, top), (width, height) = place[lane], self.size[lane]
            if width:
                found.captions[w] = (x + width / 2, top + height / 2)
        return found

    def _across(self, columns: Sequence[Sequence[str]], y: Mapping[str, float]) -> _Columns:
        """Return the columns from left to right; the first and the last hold the wires of the border."""
        widths = [max((self.size[n][0] for n in column), default=0.0) for column in columns]
        spaces = self._spaces(y)
        x, lefts = self.margin, [0.0]
        for c in range(1, self.last):
            lefts.append(x)
            x += widths[c]
            if c + 1 < self.last:
                x += spaces[c]
        shift = max(0.0, spaces[0] - FRAME) if columns[0] else 0.0
        right = x + (max(FRAME, spaces[-2]) if columns[-1] else self.margin) + shift
        spare = max(0.0, self.least - right)  # the name of a group is wider than its content
        inner = [left + shift + spare / 2 for left in lefts[1:]]
        return _Columns([0.0, *inner, right + spare], widths, right + spare)

    def _spaces(self, y: Mapping[str, float]) -> list[float]:
        """Return the space behind each column, which grows with the steepest climb of a connection there."""
        climbs = [0.0] * (self.last + 1)
        for w, path in self.path.items():
            for a, b in itertools.pairwise(path):
                climb = abs(y[a] + self._end(a, RIGHT, w) - y[b] - self._end(b, LEFT, w))
                climbs[self.column[a]] = max(climbs[self.column[a]], climb)
        return [min(WIDEST_GAP, GAP + STEEPEST * climb) for climb in climbs]

    def _runs(
        self,
        w: int,
        path: Sequence[str],
        place: Mapping[str, tuple[float, float]],
        across: _Columns,
    ) -> list[Segment]:
        runs: list[Segment] = []
        for k, n in enumerate(path):
            x, y = place[n]
            c = self.column[n]
            left, right = across.lefts[c], across.lefts[c] + across.widths[c]
            if n.startswith("lane ") and not across.widths[c]:
                continue  # this column has no box: one smooth curve to the next
            if n not in self.blocks:
                runs.append(Segment(left, right, y + self.size[n][1] / 2))
            elif k == 0:
                edge = x + self.size[n][0]
                runs.append(Segment(edge, max(edge, right), y + self.offset[n + RIGHT, w]))
            else:
                runs.append(Segment(left, x, y + self.offset[n + LEFT, w]))
        return runs


def _move_into(found: Arrangement, block: _Block, group: GroupPath, x: float, y: float) -> None:
    """Place a laid-out group into the level around it."""
    inside = block.inside
    assert inside is not None
    found.frames[group] = (x, y, inside.width, inside.height)
    found.frames.update({g: (fx + x, fy + y, w, h) for g, (fx, fy, w, h) in inside.frames.items()})
    found.boxes.update({i: (bx + x, by + y) for i, (bx, by) in inside.boxes.items()})
    found.captions.update({w: (cx + x, cy + y) for w, (cx, cy) in inside.captions.items()})
    for w, runs in inside.runs.items():
        moved = [Segment(r.x0 + x, r.x1 + x, r.y + y) for r in runs]
        outside = found.runs.get(w, [])
        found.runs[w] = sorted([*outside, *moved], key=lambda r: (r.x0, r.x1))


def _key(child: str | GroupPath) -> str:
    return f"item {child}" if isinstance(child, str) else "group " + "\0".join(child)


def _port(wire: int) -> str:
    return f"port {wire}"
