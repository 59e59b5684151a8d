"""Connections: through the connectors of groups, and in the order in which cedar computes.

A step reads what its source gave last. Here a step of the model leads from t to t + dt, so that in iteration
n of cedar

* the output of a field is g(u(n - 1)), which is deodar's output at the beginning of the step: a step that
  comes later in the iteration reads it directly, one that comes earlier as `delayed`, from 0;
* so does what follows from it, such as a gain;
* an activation, a memory trace or a read-out is u(n), which a later step reads as `current` and an earlier
  one as `previous`.

What no looped step feeds is computed before the first iteration and read directly. A step that such a
source and a field feed together does not begin with 0: an earlier step reads a copy of it, whose own inputs
are those of the iteration before.
"""

from __future__ import annotations

import dataclasses as dc
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from deodar.couplings.delays import Delay
from deodar.element import Element
from deodar.elements.placeholder import Placeholder
from deodar.elements.stimuli import Boost
from deodar.importers.report import Line
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers.cedar.file import CedarGroup, CedarWire, StepPath, text
from deodar_interop.importers.cedar.grid import Counts, SampleGrid
from deodar_interop.importers.cedar.piece import OutputSlot, StepPiece

WireEnd = tuple[str, StepPath, str]
"""`step` or `connector`, the path of the step or of the connector's group, and the slot or connector."""


READER = "cedar.processing.steps.BufferReader"
BUFFER = "buffer "
"""Before the name of a buffer, which only a BufferReader reads."""


@dc.dataclass(frozen=True)
class StepWire:
    """A connection between two steps, possibly through connectors of groups."""

    source: StepPath
    source_slot: str
    target: StepPath
    target_slot: str

    @property
    def what(self) -> str:
        """The source as cedar writes it."""
        return f"{'.'.join(self.source)}.{self.source_slot}"


def step_wires(root: CedarGroup) -> tuple[list[StepWire], list[Line]]:
    """Return all connections between steps, and report lines about those that lead nowhere."""
    lines: list[Line] = []
    into: dict[WireEnd, list[WireEnd]] = {}
    for group in root.all_groups():
        for wire in group.wires:
            source = _end(group, wire.source, wire.source_slot, wire, lines)
            target = _end(group, wire.target, wire.target_slot, wire, lines)
            if source is not None and target is not None:
                into.setdefault(target, []).append(source)
    out: list[StepWire] = []
    for target in into:
        if target[0] == "step":
            out += [StepWire(path, slot, target[1], target[2]) for _, path, slot in _origins(target, into)]
    return out, lines


def buffers(root: CedarGroup) -> list[StepWire]:
    """Return the connections of the steps that read a buffer of another step by its path."""
    out: list[StepWire] = []
    for group in root.all_groups():
        for step in group.steps.values():
            if step.kind != READER:
                continue
            name, _, slot = text(step.values.get("buffer path")).rpartition(".")
            source = (*group.path, *name.split("."))
            out.append(StepWire(source, f"{BUFFER}{slot}", step.path, "buffer"))
    return out


def _end(group: CedarGroup, name: str, slot: str, wire: CedarWire, lines: list[Line]) -> WireEnd | None:
    """Return the node of one end of a connection inside a group."""
    if name in group.steps:
        return ("step", group.steps[name].path, slot)
    if name in group.groups:
        return ("connector", group.groups[name].path, slot)
    if name in group.connectors:
        return ("connector", group.path, name)
    where = ".".join((*group.path, wire.target))
    lines.append(Line(where, "connection", str(wire), "dropped", f"there is no element {name!r}"))
    return None


def _origins(target: WireEnd, into: Mapping[WireEnd, list[WireEnd]]) -> list[WireEnd]:
    """Return the output slots that lead to a node, through any number of connectors."""
    slots: list[WireEnd] = []
    seen: set[WireEnd] = {target}
    stack = list(reversed(into[target]))
    while stack:
        node = stack.pop()
        if node[0] == "step":
            if node not in slots:
                slots.append(node)
        elif node not in seen:
            seen.add(node)
            stack += reversed(into.get(node, []))
    return slots


InGroup = tuple[tuple[str, ...], str]
"""An element of the document: its group and its name."""

PlacedWire = tuple[InGroup, str, InGroup, str, str]
"""Source, its port, target, its port, and what the connection reads."""


class CedarWiring:
    """The connections of a file between deodar's elements, and the elements that they need.

    Args:
        pieces: translations of the steps.
        into: connections into each step.
        place: places of the steps in an iteration, of those that run in it.
        halted: steps that cedar does not run, and why.
        names: names in use in each group.
        grid: axes of the sizes.
        early: steps of an iteration that are computed when a file is loaded; all others begin with 0.
    """

    def __init__(
        self,
        pieces: Mapping[StepPath, StepPiece],
        into: Mapping[StepPath, Sequence[StepWire]],
        place: Mapping[StepPath, int],
        halted: Mapping[StepPath, str],
        names: Mapping[StepPath, FreeNames],
        grid: SampleGrid,
        early: frozenset[StepPath],
    ) -> None:
        self.pieces = pieces
        self.place = place
        self.halted = halted
        self.names = names
        self.grid = grid
        self.early = early
        self.into = into
        self.extra: list[tuple[StepPath, Element]] = []
        self.connections: list[PlacedWire] = []
        self.lines: list[Line] = []
        self.pending: list[tuple[StepPath, int]] = []
        self.copies: dict[tuple[StepPath, int], dict[str, str]] = {}
        self.registers: dict[tuple[StepPath, str, str, int], str] = {}

    def connect_all(self) -> None:
        """Connect all steps."""
        for path, piece in self.pieces.items():
            group = path[:-1]
            self.connections += inside(piece, group, {e.name: e.name for e in piece.elements})
            counts = Counter[str]()
            for wire in self.into.get(path, ()):
                self.connect(wire, counts[wire.target_slot], piece)
                counts[wire.target_slot] += 1
        while self.pending:
            self.connect_copy(*self.pending.pop())

    def connect(self, wire: StepWire, k: int, piece: StepPiece) -> None:
        """Connect the k-th source of a slot, and report it."""
        where = ".".join(wire.target)
        if wire.target_slot not in piece.inlets:
            self.drop(where, wire, f"there is no slot {wire.target_slot!r} with an effect here")
            return
        listed = piece.inlets[wire.target_slot]
        if wire.target_slot in piece.sums:
            k = 0
        if k >= len(listed):
            self.drop(where, wire, f"cedar refuses it: the slot {wire.target_slot!r} takes one connection")
            return
        source = self.pieces[wire.source]
        outlet = source.outlets.get(wire.source_slot)
        if outlet is None:
            outlets = ", ".join(source.outlets) or "none"
            self.drop(where, wire, f"there is no output slot {wire.source_slot!r}; there is {outlets}")
            return
        input_size = piece.wanted.get(wire.target_slot)
        if input_size is not None and not fits(outlet.dims, input_size, wire.target_slot in piece.sums):
            why = f"cedar refuses it: size {list(outlet.dims)} into {list(input_size)}"
            self.drop(where, wire, why)
            return
        name, port, reads = self.tap(wire.source, outlet, self.lag(wire.source, wire.target))
        for inlet in listed[k]:
            self.connections.append(
                ((wire.source[:-1], name), port, (wire.target[:-1], inlet.name), inlet.port, reads)
            )
        halted = wire.source in self.halted
        doubt = f"cedar does not run {wire.source[-1]!r}; 0 arrives" if halted else outlet.doubt
        verdict = "approximated" if doubt else "carried"
        self.lines.append(Line(where, "connection", wire.what, verdict, doubt or _way(reads)))

    def nothing(self, path: StepPath, outlet: OutputSlot) -> str:
        """Return a boost of 0 in the place of an output of a step that cedar does not run."""
        key = (path, outlet.name, outlet.port, 0)
        if key not in self.registers:
            group = path[:-1]
            self.registers[key] = self.names[group].new(f"{outlet.name} stopped")
            self.extra.append((group, Boost(self.registers[key], self.grid.axes(outlet.dims), 0.0)))
        return self.registers[key]

    def drop(self, where: str, wire: StepWire, why: str) -> None:
        """Report a connection that is not made."""
        self.lines.append(Line(where, "connection", wire.what, "dropped", why))

    def lag(self, source: StepPath, target: StepPath) -> int:
        """Return 1 if the target comes before the source in an iteration, or is the source, else 0."""
        return int(self.place.get(source, -1) >= self.place.get(target, 0))

    def tap(self, path: StepPath, outlet: OutputSlot, lag: int) -> tuple[str, str, str]:
        """Return an element, its port, and what to read, for the value of `lag` iterations ago."""
        if path in self.halted and not isinstance(self.pieces[path].elements[0], Placeholder):
            return self.nothing(path, outlet), "output", ""
        if path not in self.place:
            return outlet.name, outlet.port, ""
        if outlet.state:
            if lag < 2:
                return outlet.name, outlet.port, "previous" if lag else "current"
            return self.register(path, outlet, lag - 1), "output", "previous"
        if not lag:
            return outlet.name, outlet.port, ""
        if path in self.early:
            return self.copy(path, lag)[outlet.name], outlet.port, ""
        if lag == 1:
            return outlet.name, outlet.port, "delayed"
        return self.register(path, outlet, lag), "output", "previous"

    def copy(self, path: StepPath, lag: int) -> dict[str, str]:
        """Return the names of a copy of a step's elements whose values are those of `lag` iterations ago."""
        if (path, lag) not in self.copies:
            group, piece = path[:-1], self.pieces[path]
            names = {e.name: self.names[group].new(f"{e.name} before") for e in piece.elements}
            self.copies[path, lag] = names
            self.extra += [(group, dc.replace(e, name=names[e.name])) for e in piece.elements]
            self.connections += inside(piece, group, names)
            self.pending.append((path, lag))
        return self.copies[path, lag]

    def connect_copy(self, path: StepPath, lag: int) -> None:
        """Connect the inputs of a copy, each to its value one iteration earlier than the step's own."""
        piece, names, counts = self.pieces[path], self.copies[path, lag], Counter[str]()
        for wire in self.into.get(path, ()):
            k = 0 if wire.target_slot in piece.sums else counts[wire.target_slot]
            counts[wire.target_slot] += 1
            listed = piece.inlets.get(wire.target_slot, [])
            outlet = self.pieces[wire.source].outlets.get(wire.source_slot)
            if outlet is None or k >= len(listed):
                continue
            name, port, reads = self.tap(wire.source, outlet, lag + self.lag(wire.source, path))
            self.connections += [
                ((wire.source[:-1], name), port, (path[:-1], names[inlet.name]), inlet.port, reads)
                for inlet in listed[k]
            ]

    def register(self, path: StepPath, outlet: OutputSlot, lag: int) -> str:
        """Return the last of a chain of `lag` registers that delay an output by one step each."""
        key = (path, outlet.name, outlet.port, lag)
        if key not in self.registers:
            group = path[:-1]
            name = self.names[group].new(f"{outlet.name} before")
            self.registers[key] = name
            before = outlet.name if lag == 1 else self.register(path, outlet, lag - 1)
            port = outlet.port if lag == 1 else "output"
            self.extra.append((group, Delay(self.grid.axes(outlet.dims), name=name)))
            self.connections.append(((group, before), port, (group, name), "input", ""))
        return self.registers[key]


def inside(piece: StepPiece, group: StepPath, names: Mapping[str, str]) -> list[PlacedWire]:
    """Return the connections among the elements of one step; `names` are their names here."""
    out: list[PlacedWire] = []
    for a, c, *ports in piece.inner:
        port, reads, out_port = (*ports, *("input", "", "output")[len(ports) :])
        out.append(((group, names[a]), out_port, (group, names[c]), port, reads))
    return out


def loaded(
    pieces: Iterable[StepPath],
    place: Mapping[StepPath, int],
    feeds: Mapping[StepPath, Sequence[StepPath]],
    looped: frozenset[StepPath],
) -> frozenset[StepPath]:
    """Return the steps of an iteration that are computed when a file is loaded: what sources feed, possibly
    through other steps.
    """
    reached: set[StepPath] = set()
    stack = [path for path in pieces if path not in place]
    while stack:
        for target in feeds.get(stack.pop(), ()):
            if target in place and target not in looped and target not in reached:
                reached.add(target)
                stack.append(target)
    return frozenset(reached)


def fits(source: Counts, target: Counts, adds: bool) -> bool:
    """Return whether cedar accepts a size at a slot; one number is added to all samples."""
    return source == target or (adds and not source)


def _way(reads: str) -> str:
    return f"reads {reads}" if reads in ("current", "delayed") else ""


def halts(pieces: Mapping[StepPath, StepPiece], wires: Sequence[StepWire]) -> dict[StepPath, str]:
    """Return the steps with a size of their own that cedar does not run, and its reason.

    One input that does not fit stops the whole step, and so does one from a step that gives nothing.
    """
    reasons = {path: why for path, piece in pieces.items() if (why := piece.stops or piece.fails)}
    arriving: dict[StepPath, set[str]] = {}
    for wire in wires:
        piece, source = pieces[wire.target], pieces[wire.source]
        arriving.setdefault(wire.target, set()).add(wire.target_slot)
        outlet = source.outlets.get(wire.source_slot)
        input_size = piece.wanted.get(wire.target_slot)
        if wire.target in reasons or outlet is None or input_size is None:
            continue
        if source.stops:
            reasons[wire.target] = f"{wire.what} gives nothing: {source.stops}"
        elif not fits(outlet.dims, input_size, wire.target_slot in piece.sums):
            reasons[wire.target] = f"size {list(outlet.dims)} of {wire.what} into {list(input_size)}"
    for path, piece in pieces.items():
        missing = [slot for slot in piece.needs if slot not in arriving.get(path, set())]
        if path not in reasons and missing:
            reasons[path] = f"nothing is connected to {missing[0]!r}"
    return reasons
