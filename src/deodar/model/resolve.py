"""Convert a document to nodes: infer axes at every port, fit connections, list every problem.

Implicit resampling, contraction, expansion and delays become nodes of their own, so that later stages see
only connections between equal axes.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import math
from collections import Counter
from collections.abc import Callable, Collection, Generator, Iterable, Sequence
from typing import Any, Literal, TypeVar

from deodar.couplings.delays import Delay
from deodar.couplings.projections import Project
from deodar.element import Element
from deodar.errors import ConnectionFix, EditFix, KindError, Problem
from deodar.kind_errors import errors_of_kind
from deodar.leaves import leaves
from deodar.model.document import Connection, Document, Entry
from deodar.model.paths import quote
from deodar.numerics.axes import Axes, Axis, describe, shape
from deodar.parameters import parameters
from deodar.proposed_edit import InsertCoupling, SetReads

T = TypeVar("T")
Instant = Literal[0, 1]
Slot = tuple[str, str, Instant]
"""Element id, output port, and the time of reading: 0 at time t, 1 at t + dt."""

BETWEEN = "Give both the same axes, or put a coupling between them"
"""What helps where a source does not fit, for a reader of the page, which offers the couplings."""


@dc.dataclass(frozen=True)
class Node:
    """One resolved element."""

    id: str
    path: str
    element: Element
    every: int
    ins: dict[str, Axes]
    outs: dict[str, Axes]
    reads: dict[str, list[Slot]]
    level: tuple[int, ...] = ()
    declared: bool = True

    def axes(self, port: str) -> Axes:
        """Return the axes at a port, an output or an input."""
        return self.outs[port] if port in self.outs else self.ins[port]

    def passes(self, port: str) -> Sequence[str]:
        """Return the input ports that an output port passes on in the same instant."""
        return type(self.element).direct.get(port, ())

    def shows_state(self, port: str) -> bool:
        """Return whether an output port shows the state, so that it may be read before and after a step."""
        return self.element.stateful and not self.passes(port)

    @property
    def deferred(self) -> bool:
        """Whether its outputs depend on inputs of the same instant."""
        return any(self.passes(port) for port in self.outs)


def reach(start: Iterable[T], following: Callable[[T], Iterable[T]]) -> set[T]:
    """Return what a walk of a graph reaches, its start included."""
    reached = set(start)
    ahead = list(reached)
    while ahead:
        new = set(following(ahead.pop())) - reached
        reached |= new
        ahead += new
    return reached


def readers(nodes: Collection[Node]) -> dict[str, set[str]]:
    """Return, for each node, the ids of the nodes that read one of its outputs."""
    reading: dict[str, set[str]] = {n.id: set() for n in nodes}
    for n in nodes:
        for slots in n.reads.values():
            for source, _, _ in slots:
                reading[source].add(n.id)
    return reading


class _Resolver:
    def __init__(self, doc: Document) -> None:
        self.doc = doc
        self.entries = doc.by_id()
        self.problems: list[Problem] = []
        self.nodes: dict[str, Node] = {}
        self.into: dict[tuple[str, str], list[Connection]] = {}
        for c in sorted(doc.connections, key=lambda c: (c.source, c.source_port)):
            self.into.setdefault((c.target, c.target_port), []).append(c)
        self.visiting: list[str] = []
        self.delayed: set[str] = set()
        self.later: list[tuple[Node, str, Connection]] = []
        self.failed: set[str] = set()
        self.feeds: dict[str, list[str]] = {}
        self.reported: set[Problem] = set()
        self.after: tuple[str, set[str]] = ("", set())

    def run(self) -> list[Node]:
        for ident in self.upstream_first():
            self.visit(ident)
        for entry in self.doc.entries:
            node = self.nodes.get(entry.id)
            if node is not None and not node.deferred:
                with self.problems_of(entry):
                    self.wire(node)
        for node, port, c in self.later:
            if c.source in self.nodes and node.id not in self.failed:
                slot = self.slot(self.nodes[c.source], c, node)
                if slot is not None:
                    self.attach(self.nodes[c.source], slot, node, port)
        for entry in self.doc.entries:
            node = self.nodes.get(entry.id)
            if node is not None:
                with self.problems_of(entry):
                    self.inspect(entry, node)
        return list(self.nodes.values())

    def upstream_first(self) -> list[str]:
        """Return every element after those whose axes it takes over, elements of loops last.

        This order bounds the depth of the recursion of `visit` for chains of any length.
        """
        ports = {e.id: self._direct_ports(e.element) for e in self.doc.entries}
        waits = {
            i: {c.source for p in direct for c in self.into.get((i, p), []) if ports[c.source]}
            for i, direct in ports.items()
        }
        feeds = self.feeds = {i: [] for i in ports}
        for i, direct in ports.items():
            for source in {c.source for p in direct for c in self.into.get((i, p), [])}:
                feeds[source].append(i)
        ready = [i for i, sources in waits.items() if not sources]
        for i in ready:  # the list grows during the loop
            for follower in feeds[i]:
                if i in waits[follower]:
                    waits[follower].discard(i)
                    if not waits[follower]:
                        ready.append(follower)
        done = set(ready)
        return ready + [i for i in ports if i not in done]

    def visit(self, ident: str) -> Node | None:
        """Return the node of an element; visit deferred ones after their sources, whose axes they may take
        over.
        """
        if ident in self.nodes:
            return self.nodes[ident]
        entry = self.entries[ident]
        if ident in self.visiting:
            ring = self.visiting[self.visiting.index(ident) :][::-1]
            first = ring.index(min(ring, key=lambda i: self.entries[i].path))
            ring = ring[first:] + ring[:first]  # reported once, with the same first element in any order
            loop = " -> ".join(self.entries[i].path for i in [*ring, ring[0]])
            self.failed.add(ident)
            ident = ring[0]
            if self.delayed & {*ring}:
                fault = f"the axes of a loop follow only from themselves and are unknown: {loop}"
                advice = "Connect something to it whose axes are known, or put a Project into it"
                path, ports = self.entries[ident].path, self.entries[ident].element.ports()
                self.problem(ident, fault, ConnectionFix(advice, advice, ("", "", path, ports[0])))
            else:
                self.problem(ident, f"a loop without a state in it: {loop}", self.delay(ring))
            return None
        with self.problems_of(entry):
            return self.resolved(entry)
        return None

    def delay(self, ring: Sequence[str]) -> EditFix:
        """Return the fix of a loop without a state: a delay, where possible in front of an element that other
        connections give its axes.
        """
        closings: list[tuple[bool, list[Connection]]] = []
        for source, target in zip([ring[-1], *ring], ring, strict=False):
            ports = sorted(self._direct_ports(self.entries[target].element))
            arriving = [c for port in ports for c in self.into.get((target, port), [])]
            closing = [c for c in arriving if c.source == source and c.reads != "delayed"]
            closings.append((len(closing) == len(arriving), closing))
        _, closing = min(closings, key=lambda alone_and_closing: alone_and_closing[0])
        delays = [self.reads(c, "delayed") for c in closing]
        return EditFix("Delay one of its connections by a step", delays, "Or put a field into it")

    def reads(self, c: Connection, instant: str) -> SetReads:
        """Return the edit that lets a connection read another instant."""
        source, target = self.entries[c.source].path, self.entries[c.target].path
        return SetReads(f"{source}.{quote(c.source_port)}", f"{target}.{quote(c.target_port)}", instant)

    def resolved(self, entry: Entry) -> Node | None:
        """Return the node of an element, with the axes at its ports."""
        ident = entry.id
        node = Node(
            ident,
            entry.path,
            entry.element,
            entry.every,
            {},
            {},
            {port: [] for port in entry.element.ports()},
        )
        deferred = bool(type(entry.element).direct) and any(type(entry.element).direct.values())
        if deferred:
            self.visiting.append(ident)
            self.wire(node, only=self._direct_ports(entry.element))
            self.visiting.pop()
            if ident in self.failed:
                return None
        try:
            node.outs.update(entry.element.outputs(node.ins))
        except KeyError as error:
            if error.args[0] not in node.reads:  # not for lack of a source
                raise
            return None
        self.nodes[ident] = node
        if deferred:
            self.wire(node, skip=self._direct_ports(entry.element))
        return node

    def follows(self, ident: str, origin: str) -> bool:
        """Return whether the axes of a coupling follow, through couplings, from those of another."""
        if self.after[0] != origin:  # called for all sources of one element in sequence
            self.after = (origin, reach([origin], self.feeds.__getitem__))
        return ident in self.after[1]

    def _direct_ports(self, element: Element) -> set[str]:
        return {port for ports in type(element).direct.values() for port in ports}

    def wire(self, node: Node, only: set[str] | None = None, skip: set[str] | None = None) -> None:
        """Set the axes at the input ports, and the slots they read."""
        for port in node.element.ports():
            if (only is not None and port not in only) or (skip is not None and port in skip):
                continue
            arriving = self.into.get((node.id, port), [])
            closing = [c for c in arriving if c.reads == "delayed" and self.follows(c.source, node.id)]
            self.join(node, port, [c for c in arriving if c not in closing])
            if port in node.ins:  # loops with a delay: the other connections have determined the axes
                self.later += [(node, port, c) for c in closing]
            else:
                self.join(node, port, closing)
            if port not in node.ins:
                axes = node.element.input_axes(port, None)
                if axes is None and not node.reads[port]:
                    if (
                        port == "input"
                        and node.id not in self.failed
                        and node.element.input_axes(port, ()) == ()
                    ):
                        self.problem(
                            node.id,
                            f"nothing is connected to {node.path}.{port}, so its axes are unknown",
                            ConnectionFix.into(node.path),
                        )
                        continue
                    axes = node.ins.get("input", ())
                node.ins[port] = axes if axes is not None else ()

    def join(self, node: Node, port: str, connections: Sequence[Connection]) -> None:
        """Join the connections into one port.

        At a port that accepts any axes the source with the most axes and samples determines them; others
        expand.
        """
        arriving: list[tuple[Node, Slot, Axes]] = []
        for c in connections:
            if c.reads == "delayed":
                self.delayed.add(c.source)
            source = self.visit(c.source)
            if source is None:
                self.failed.add(node.id)
                continue
            slot = self.slot(source, c, node)
            if slot is not None:
                arriving.append((source, slot, source.outs[c.source_port]))
        for source, slot, _ in sorted(arriving, key=lambda f: (-len(f[2]), -math.prod(shape(f[2])))):
            self.attach(source, slot, node, port)

    def slot(self, source: Node, c: Connection, node: Node) -> Slot | None:
        """Return what a connection reads; a delay becomes a node."""
        if c.source_port not in source.outs:
            self.problem(
                node.id,
                f"{source.path} has no output port {c.source_port!r}",
                f"Output ports: {', '.join(source.outs)}",
            )
            return None
        if c.target_port in node.element.bounded_inputs:
            c = dc.replace(c, source_port=source.element.bounded_port(c.source_port))
        if c.reads == "delayed":
            ident = f"{source.id}.{c.source_port}~"
            if ident not in self.nodes:
                axes = source.outs[c.source_port]
                delay = Delay(axes=axes, name=f"{source.path}.{c.source_port} delayed")
                self.nodes[ident] = Node(
                    ident,
                    delay.name,
                    delay,
                    1,
                    {"input": axes},
                    {"output": axes},
                    {"input": [(source.id, c.source_port, 0)]},
                    declared=False,
                )
            return (ident, "output", 0)
        if c.reads and not source.shows_state(c.source_port):
            self.problem(
                node.id,
                f"the connection {source.path}.{c.source_port} -> {node.path}.{c.target_port} says"
                f" {c.reads!r}, but {source.path} shows no state: its output is of the same instant as its"
                " input",
                EditFix("Leave reads out", [self.reads(c, "")], "Or let it read 'delayed'"),
            )
            return None
        return (source.id, c.source_port, 1 if c.reads == "current" else 0)

    def attach(self, source: Node, slot: Slot, node: Node, port: str) -> None:
        axes = self.nodes[slot[0]].outs[slot[1]] if slot[0] in self.nodes else source.outs[slot[1]]
        want = node.element.input_axes(port, axes)
        if want is not None and want == axes and port in node.ins:
            want = node.ins[port]  # a port that accepts any axes took those of its first connection
        if want is None:
            want = axes
        followed = type(node.element).follows.get(port, "")
        if followed in node.ins:
            want = node.ins[followed]
            if {a.name for a in axes} > {a.name for a in want}:
                ends = (source.path, self.stated(slot, node, port), node.path, port)
                places = f"et the two change places; the port {followed!r} takes the larger one"
                self.problem(
                    node.id,
                    f"{ends[0]}.{ends[1]} {describe(axes)} does not fit {node.path}.{port} {describe(want)}:"
                    " it has more axes",
                    ConnectionFix(f"Write: l{places}", f"L{places}. Or put a coupling between them", ends),
                )
                return
        node.ins[port] = want
        if axes != want:
            fitted = self.fit(source, slot, axes, node, port, want)
            if fitted is None:
                return
            slot = fitted
        node.reads[port].append(slot)

    def fit(self, source: Node, slot: Slot, axes: Axes, node: Node, port: str, want: Axes) -> Slot | None:
        """Return a slot over the wanted axes, through an implicit projection, or report a problem that names
        both sides.
        """
        reason = misfit(axes, want)
        if reason:
            ends = (source.path, self.stated(slot, node, port), node.path, port)
            self.problem(
                node.id,
                f"{ends[0]}.{ends[1]} {describe(axes)} does not fit {node.path}.{port} {describe(want)}:"
                f" {reason}",
                _renaming(ends, axes, want)
                or ConnectionFix(f"Write: {_remedy(source.path, node.path, axes, want)}", BETWEEN, ends),
            )
            return None
        key = ",".join(f"{a.name}:{a.samples}" for a in want)
        ident = f"{slot[0]}.{slot[1]}@{slot[2]}>{key}"
        if ident not in self.nodes:
            project = Project(want, name=f"{source.path}.{slot[1]} to {key}")
            self.nodes[ident] = Node(
                ident,
                project.name,
                project,
                1,
                {"input": axes},
                {"output": want},
                {"input": [slot]},
                declared=False,
            )
        return (ident, "output", 0)

    def stated(self, slot: Slot, node: Node, port: str) -> str:
        """Return the output port that the document states for a slot, also of a delay.

        Inputs that need numbers between 0 and 1 read the `bounded_port` of it.
        """
        before = self.nodes[slot[0]]
        ident, out, _ = slot if before.declared else before.reads["input"][0]
        ports = [c.source_port for c in self.into.get((node.id, port), []) if c.source == ident]
        bounded_port = self.nodes[ident].element.bounded_port
        return out if out in ports else next((p for p in ports if bounded_port(p) == out), out)

    def inspect(self, entry: Entry, node: Node) -> None:
        """Report parameters that do not fit the axes."""
        if not self.per_axis(entry, node):
            return
        axes: Any = getattr(entry.element, "axes", ())
        twice = sorted(name for name, count in Counter(a.name for a in axes).items() if count > 1)
        if twice:
            self.problem(
                node.id, f"two of its axes are called {twice[0]!r}", "Give each axis a name of its own"
            )
            return
        if node.id in self.failed:
            return  # a problem of the inputs would only be reported a second time
        for fault in entry.element.validate_axes(node.ins):
            self.problem(node.id, *(fault if isinstance(fault, tuple) else self.between(node, fault)))
        clash = {p.name for p in parameters(type(entry.element))} & {*node.outs, *node.ins} - {"noise"}
        if clash:
            self.problem(
                node.id,
                f"a port and a parameter are both called {sorted(clash)[0]!r}",
                "Rename one of them in the element's class",
            )

    def between(self, node: Node, fault: str) -> tuple[str, str]:
        """Return the problem of a coupling whose input does not fit, with both of its ends, and the line to
        type.
        """
        for port in node.ins if node.deferred else ():
            for c in self.into.get((node.id, port), []):
                source, target_axes = (
                    self.entries[c.source].path,
                    describe(getattr(node.element, "axes", node.ins[port])),
                )
                names = ", ".join(a.name for a in getattr(node.element, "axes", node.ins[port]))
                ends = (
                    f"{source}.{c.source_port} {describe(node.ins[port])} does not fit {node.path}.{port}"
                    f" {target_axes}: {fault}"
                )
                return (
                    ends,
                    ConnectionFix(
                        f"Give both the same axes, or write: {source} >> Resample([{names}]) >> {node.path}"
                        f" keeps the part they share and loses the rest; {source} >> Project([{names}]) >>"
                        f" {node.path} loses the places along every axis that is missing in it: it integrates"
                        " over them",
                        BETWEEN,
                        (source, c.source_port, node.path, port),
                    ),
                )
        return fault, ""

    def per_axis(self, entry: Entry, node: Node) -> bool:
        """Return whether values given per axis are as many as the axes."""
        element_axes: Any = getattr(entry.element, "axes", None)
        axes: Axes = tuple(element_axes) if element_axes is not None else node.ins.get("input", ())
        good = True
        counted: dict[str, int] = {}
        for path, _, p in leaves(entry.element):
            if p.form == "per_axis" and path.rsplit(".", 1)[-1].isdigit() and not path.endswith(p.name):
                base = path.rsplit(".", 1)[0]
                counted[base] = counted.get(base, 0) + 1
        for base, count in counted.items():
            if count != len(axes):
                self.problem(
                    node.id,
                    f"{base} has {count} values for {len(axes)} axes",
                    "Give one number, or one for each axis",
                )
                good = False
        return good

    @contextlib.contextmanager
    def problems_of(self, entry: Entry) -> Generator[None]:
        """Report an exception of the class of an element as a problem."""
        try:
            with errors_of_kind(entry.element):
                yield
        except KindError as error:
            if entry.id in self.visiting:
                del self.visiting[self.visiting.index(entry.id) :]
            for p in error.problems:
                self.problem(entry.id, p.what, p.fix)

    def problem(self, ident: str, fault: str, fix: str = "") -> None:
        self.failed.add(ident)
        problem = Problem(self.entries[ident].path if ident in self.entries else ident, fault, fix)
        if problem not in self.reported:
            self.reported.add(problem)
            self.problems.append(problem)


def resolve(doc: Document) -> tuple[list[Node], list[Problem]]:
    """Return the nodes of a document and all of its problems."""
    resolver = _Resolver(doc)
    nodes = resolver.run()
    place = {e.path: k for k, e in enumerate(doc.entries)}
    return nodes, sorted(resolver.problems, key=lambda p: place.get(p.where, len(place)))


def _renaming(ends: tuple[str, str, str, str], axes: Axes, want: Axes) -> EditFix | None:
    """Return the fix of two ports whose axes differ by the name of one axis; None: they differ more."""
    missing, extra = _apart(want, axes), _apart(axes, want)
    if _unlike(axes, want) or not len(missing) == len(extra) == 1:
        return None
    if not dc.replace(extra[0], unit="").fits(dc.replace(missing[0], unit="")):
        return None
    if extra[0].unit and missing[0].unit and extra[0].unit != missing[0].unit:
        return None  # a position in degrees is none in millimetres: a person decides
    renamed = ((extra[0].name, missing[0].name),)
    coupling = InsertCoupling(ends, "Project", tuple(a.name for a in want), renamed)
    return EditFix("Rename the axis by a coupling", [coupling])


def misfit(axes: Axes, want: Axes) -> str:
    """Return why a connection from axes to other axes needs a coupling between them; "" if it needs none."""
    target_names, source_names = {a.name for a in want}, {a.name for a in axes}
    if bad := _unlike(axes, want):
        return f"bounds, unit or periodicity of {bad[0]!r} differ"
    return (
        "axes are missing on both sides"
        if source_names - target_names and target_names - source_names
        else ""
    )


def _unlike(axes: Axes, want: Axes) -> list[str]:
    """Return the names of axes that both have with another range, unit or boundary."""
    targets = {a.name: a for a in want}
    return [a.name for a in axes if a.name in targets and not a.fits(targets[a.name])]


def _apart(axes: Axes, others: Axes) -> list[Axis]:
    """Return the axes whose names others lack."""
    names = {b.name for b in others}
    return [a for a in axes if a.name not in names]


def _remedy(source: str, target: str, axes: Axes, want: Axes) -> str:
    """Return what to write between two ports that do not fit.

    First the coupling that keeps the positions of the source, then the loss of a `Project` or a `Resample`.
    """

    def chain(coupling: str) -> str:
        ends = [
            path if path.replace(".", "_").isidentifier() else f"model[{path!r}]" for path in (source, target)
        ]
        return f"{ends[0]} >> {coupling} >> {ends[1]}"

    names = ", ".join(a.name for a in want)
    if _unlike(axes, want):
        return _regrid(chain, axes, want, names)
    missing, extra = _apart(want, axes), _apart(axes, want)
    one_axis = len(missing) == len(extra) == 1
    ways = _diagonal(chain, axes, want, names)
    ways.append(f"{chain(f'Weights(w, [{names}])')} with an array w that says which place goes where")
    if one_axis:
        ways.append(f"give both the same axis, if {extra[0].name} and {missing[0].name} are one dimension")
    lost, flat = (", ".join(a.name for a in found) for found in (extra, missing))
    project = chain(f"Project([{names}])")
    if len(extra) == len(axes) and len(missing) == len(want):
        lose = (
            f"{project} loses the signal: it keeps one number, the integral over {lost}, and {target} is"
            f" uniform along {flat}"
        )
    else:
        lose = (
            f"{project} loses the places: it integrates over {lost}, and {target} gets the same value"
            f" everywhere along {flat}"
        )
    return f"{', or '.join(ways)}. {lose}"


def _diagonal(chain: Callable[[str], str], axes: Axes, want: Axes, names: str) -> list[str]:
    """Return the couplings between two axes and one as long as both."""
    ways: list[str] = []
    if len(axes) == 2 and [a.samples for a in want] == [sum(shape(axes)) - 1]:
        ways.append(f"{chain(f'DiagonalSum([{names}])')} where the target is the sum of the two")
    if len(want) == 2 and [a.samples for a in axes] == [sum(shape(want)) - 1]:
        ways.append(f"{chain(f'DiagonalExpansion([{names}])')} where the source is the sum of the two")
    return ways


def _regrid(chain: Callable[[str], str], axes: Axes, want: Axes, names: str) -> str:
    """Return what to write where an axis of the same name has other bounds, another unit or another
    boundary.
    """
    targets = {a.name: a for a in want}
    pairs = [(a, targets[a.name]) for a in axes if a.name in targets and not a.fits(targets[a.name])]
    units = [(a, b) for a, b in pairs if a.unit != b.unit]
    same = f"one axis {pairs[0][0].name!r} for both"
    if units and all(dc.replace(a, unit=b.unit).fits(b) for a, b in units):
        same = (
            f"{same}: the numbers agree, only the units {units[0][0].unit!r} and {units[0][1].unit!r} differ,"
            " and one of them is probably wrong"
        )
    elif units:
        same = f"{same}, with all values in one unit ({units[0][0].unit!r} or {units[0][1].unit!r})"
    lose = f"{chain('Project([])')} loses every place: it keeps one number, the integral"
    if (
        units
        or [a.name for a in axes] != [a.name for a in want]
        or any(a.periodic and not b.periodic for a, b in pairs)
    ):
        return (
            f"{same}; or {chain(f'Weights(w, [{names}])')} with an array w that says which place goes where."
            f" {lose}"
        )
    return (
        f"{same}; or {chain(f'Resample([{names}])')}, which keeps the part they share and loses what lies"
        f" outside it. {lose}"
    )
