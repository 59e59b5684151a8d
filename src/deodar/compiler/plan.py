"""The plan between model and program: plain data without JAX, for printing and tests.

Nodes of equal structure are rows of one group, stacked on a leading axis. The schedule is a list of calls,
and every sum of the graph a list of index arrays. A planner may rewrite a plan into another one.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Hashable, Iterable, Mapping, Sequence

import numpy as np

from deodar.compiler.build import Build, cost, still
from deodar.compiler.sharing import shared
from deodar.compiler.strategies import EXACT, Strategy
from deodar.leaves import bind, leaves, structure
from deodar.model.document_graph import graph
from deodar.model.order import NodeRole
from deodar.model.resolve import Instant, Node, reach
from deodar.numerics.axes import Axes
from deodar.numerics.choice import Shards
from deodar.numerics.exact import LOW


@dc.dataclass
class RowGroup:
    """Rows of equal structure.

    Attributes:
        nodes: the rows, in the order of their ids.
        offset: for each scalar leaf, its place in the parameter vector (one entry a row).
        arrays: paths of the leaves that are arrays.
        exact: paths of the leaves that keep the digits of float64; the path with `LOW` behind it holds what
            is lost by rounding.
        cost: for each leaf, `live` or `rebuild`.
        still: whether its outputs are constant during a chunk.
        sensory: whether its outputs follow from readings of a world inside the step alone, so that they are
            constant between two readings.
        noise: axes over which a row draws noise, or None.
        strategy: the strategy for its kernels.
    """

    nodes: list[Node]
    offset: dict[str, int]
    arrays: tuple[str, ...]
    cost: dict[str, str]
    still: bool
    noise: Axes | None
    strategy: Strategy = EXACT
    exact: frozenset[str] = frozenset()
    sensory: bool = False

    @property
    def like(self) -> Node:
        """The row that represents the group."""
        return self.nodes[0]

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(self.nodes)


@dc.dataclass(frozen=True)
class Call:
    """One evaluation of a whole group."""

    group: int
    role: NodeRole
    instant: Instant


COLUMNS = 64
"""Sources of a row that are added in one expression; further ones are added by a loop, so that a program does
not grow with the number of inputs.
"""


@dc.dataclass
class Read:
    """Rows of one buffer that are added to rows of one port.

    Each row sums in the order of the sources' ids within a group of sources, and group after group in the
    order of their first ids.

    Attributes:
        source: group, port and instant of the buffer.
        table: rows of the source, (rows of the port, at most COLUMNS); an entry equal to the number of the
            source's rows means none.
        whole: whether no entry means none.
        more: where rows have more sources: the rows of the port, and the rows of their further sources,
            (blocks, COLUMNS, rows). Rows with few sources do not occur there, so the size is at most a few
            times that of the connections.
    """

    source: tuple[int, str, Instant]
    table: np.ndarray
    whole: bool
    more: Sequence[tuple[np.ndarray, np.ndarray]] = ()


@dc.dataclass
class Plan:
    """The groups, the calls in their order, and the sums of inputs."""

    groups: list[RowGroup]
    calls: list[Call]
    reads: dict[tuple[int, str], list[Read]]
    row: dict[str, tuple[int, int]]
    sensors: dict[str, int]
    size: int
    ticks: int
    shards: Shards | None = None
    """The axis that devices divide."""

    def describe(self) -> str:
        """Return the plan in words, one line per group and call."""
        lines = [
            f"{len(self.groups)} groups, {self.size} parameters, all parts meet every {self.ticks} ticks"
        ]
        for k, g in enumerate(self.groups):
            names = ", ".join(n.path for n in g.nodes[:4]) + (", ..." if g.rows > 4 else "")
            lines.append(
                f"group {k}: {g.rows} x {type(g.like.element).__name__} every"
                f" {g.like.every}{' still' if g.still else ' sensory' if g.sensory else ''}: {names}"
            )
            lines += [
                f"  {key}: {choice.method}{' shared' if key == g.strategy.shared else ''}"
                for key, choice in g.strategy.choices
            ]
        lines += [f"call: {c.role} of group {c.group} at t{' + dt' if c.instant else ''}" for c in self.calls]
        return "\n".join(lines)

    def needed(self, slots: Sequence[tuple[int, str]]) -> list[Call]:
        """Return the output calls at time t on which ports of groups depend: (group, port), including
        input ports.
        """

        def sources(g: int, ports: Iterable[str]) -> set[int]:
            # a port that an output passes on may be one that the group has not got now
            return {read.source[0] for port in ports for read in self.reads.get((g, port), ())}

        def before(g: int) -> set[int]:  # all outputs of a group are computed together
            node = self.groups[g].like
            return sources(g, [port for out in node.outs for port in node.passes(out)])

        start: set[int] = set()
        for g, port in slots:
            start |= {g} if port in self.groups[g].like.outs else sources(g, [port])
        want = reach(start, before)
        return [c for c in self.calls if c.role == "output" and c.instant == 0 and c.group in want]


def by_structure(node: Node, still: bool, neutral: frozenset[str], strategy: Strategy) -> Hashable:
    """Rows that share one group: equal level, rate, structure, axes and strategy.

    An element with an external input is alone in its group: a world feeds it by its id.
    """
    alone = node.id if node.element.external else ""
    ins, outs = tuple(sorted(node.ins.items())), tuple(node.outs.items())
    return (node.level, node.every, still, structure(node.element, neutral), ins, outs, strategy, alone)


def plan(build: Build) -> Plan:
    """Return the plan of a program.

    Raises:
        ModelError: the document has problems, which are raised together.
        DeviceError: it has no axis that the devices can divide.
    """
    acts, strategy_of = graph(build.doc).required().acts, dict(build.strategies)
    nodes, constant = shared(graph(build.doc).nodes, strategy_of), build.still
    neutral = dict.fromkeys((n.id for n in nodes), frozenset[str]())
    neutral |= {e.id: frozenset(path for _, path in build.omitted(e)) for e in build.doc.entries}
    lasting = build.body is not None and build.body.holds
    sensory = _sensory(nodes, constant) if lasting else dict.fromkeys(constant, False)
    groups, row = _groups(nodes, neutral, constant, sensory, strategy_of)
    size = _place(groups, neutral)
    calls = list(dict.fromkeys(Call(row[i][0], role, instant) for i, role, instant in acts))
    ports = [(g, port) for g, group in enumerate(groups) for port in group.like.reads]
    reads = {(g, port): _reads(groups[g], port, groups, row) for g, port in ports}
    sensors = {ident: k for k, ident in enumerate(sorted(n.id for n in nodes if n.element.external))}
    ticks = int(np.lcm.reduce([n.every for n in nodes] or [1]))
    return Plan(groups, calls, reads, row, sensors, size, ticks, build.shards)


def _sensory(nodes: Sequence[Node], constant: Mapping[str, bool]) -> dict[str, bool]:
    """Return whether each node is constant between two readings that are held, and changes with them."""
    between = still(nodes, False)
    return {n.id: between[n.id] and not constant[n.id] and not n.element.external for n in nodes}


def _groups(
    nodes: Sequence[Node],
    neutral: Mapping[str, frozenset[str]],
    constant: Mapping[str, bool],
    sensory: Mapping[str, bool],
    strategy_of: Mapping[str, Strategy],
) -> tuple[list[RowGroup], dict[str, tuple[int, int]]]:
    keys: dict[Hashable, int] = {}
    groups: list[RowGroup] = []
    row: dict[str, tuple[int, int]] = {}
    # by stored id, so that the order of declaration has no effect
    for n in sorted(nodes, key=lambda n: n.id):
        key = (by_structure(n, constant[n.id], neutral[n.id], strategy_of[n.id]), sensory[n.id])
        g = keys.setdefault(key, len(groups))
        if g == len(groups):
            # noise at its neutral strength 0 is omitted from the program, unless that value may change
            probe = bind(n.element, lambda path, n=n: None if path in neutral[n.id] else ...)
            group = RowGroup([], {}, (), {}, constant[n.id], probe.noise_axes(), strategy_of[n.id])
            groups.append(dc.replace(group, sensory=sensory[n.id]))
        row[n.id] = (g, groups[g].rows)
        groups[g].nodes.append(n)
    return groups, row


def _place(groups: Sequence[RowGroup], neutral: Mapping[str, frozenset[str]]) -> int:
    size = 0
    for g in groups:
        arrays: list[str] = []
        for path, _, p in leaves(g.like.element):
            if path in neutral[g.like.id]:
                continue
            for name in (path, path + LOW) if p.exact else (path,):
                g.cost[name] = cost(p)
                if p.form == "array":
                    arrays.append(name)
                else:
                    g.offset[name] = size
                    size += g.rows
            if p.exact:
                g.exact |= {path}
        g.arrays = tuple(arrays)
    return size


def _reads(
    group: RowGroup, port: str, groups: Sequence[RowGroup], row: Mapping[str, tuple[int, int]]
) -> list[Read]:
    rows_of: dict[tuple[int, str, Instant], list[list[int]]] = {}
    for r, n in enumerate(group.nodes):
        for ident, source_port, instant in sorted(n.reads[port]):
            g, source_row = row[ident]
            key = (g, source_port, instant)
            if key not in rows_of:
                rows_of[key] = [[] for _ in group.nodes]
            rows_of[key][r].append(source_row)
    out: list[Read] = []
    for key in sorted(rows_of):
        rows, nothing = rows_of[key], groups[key[0]].rows
        table, further = (
            _padded(rows, 0, min(COLUMNS, max(map(len, rows))), nothing),
            list[tuple[np.ndarray, np.ndarray]](),
        )
        begin = COLUMNS
        while longer := [r for r, sources in enumerate(rows) if len(sources) > begin]:
            most = max(map(len, rows)) if len(longer) == 1 else 2 * begin
            end = begin + -(-(most - begin) // COLUMNS) * COLUMNS
            block = _padded([rows[r] for r in longer], begin, end, nothing).T.reshape(
                -1, COLUMNS, len(longer)
            )
            further.append((np.asarray(longer, np.int32), block))
            begin = end
        whole = all(bool((part < nothing).all()) for part in (table, *(block for _, block in further)))
        out.append(Read(key, table, whole, further))
    return out


def _padded(rows: Sequence[Sequence[int]], begin: int, end: int, nothing: int) -> np.ndarray:
    """The entries `begin` to `end` of lists of different lengths, as a table."""
    table = np.full((len(rows), end - begin), nothing, np.int32)
    for r, sources in enumerate(rows):
        part = sources[begin:end]
        table[r, : len(part)] = part
    return table
