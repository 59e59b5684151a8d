"""Connections, by the order of the elements in the file.

Some tools compute their elements in the order of the list and in place: an element reads the values of this
step from the elements before it, and those of the previous step from the elements after it. A value that is
neither a state nor constant begins with that of its outlet. Here a step leads from t to t + dt, so that

* a state that comes before its reader is read as `current`, one that comes after it (or is the reader itself)
  as `previous`;
* a coupling or a timed stimulus that comes before its reader is read directly, one that comes after it as
  `delayed`, from zero.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from deodar.couplings.arithmetic import Gain
from deodar.couplings.delays import Delay
from deodar.element import Element
from deodar.elements.stimuli import Boost
from deodar.importers.report import Line, Verdict
from deodar.numerics.axes import Axis, shape
from deodar_interop.importers._foreign import Foreign, FreeNames, Source
from deodar_interop.importers._piece import Dims, Inlet, Outlet, Piece, axes, projection

SourceWire = tuple[str, str, str, str, str]
"""Source, its port, target, its port, and what the connection reads."""


class SourceWiring:
    """The connections of a file, and the elements that they need.

    Args:
        tool: name of the tool, for the report.
        elements: the elements of the file, in its order.
        pieces: their translations by label.
        names: the names in use.
    """

    without_input: ClassVar[Verdict] = "approximated"
    """Verdict on an input that is needed here, and to which the file connects nothing."""

    def __init__(
        self, tool: str, elements: Sequence[Foreign], pieces: Mapping[str, Piece], names: FreeNames
    ) -> None:
        self.tool = tool
        self.elements = elements
        self.place = {e.label: e.place for e in elements}
        self.pieces = pieces
        self.names = names
        self.extra: list[Element] = []
        self.connections: list[SourceWire] = []
        self.lines: list[Line] = []
        self.delays: dict[tuple[str, str], str] = {}
        self.feeds: dict[str, set[str]] = {}
        for e in self.elements:
            for s in e.sources:
                self.feeds.setdefault(s.label, set()).add(e.label)
        self.noisy = self._noisy()
        self.rings = self._rings()

    def connect_all(self) -> None:
        """Connect all inputs, in the order of the file."""
        for e in self.elements:
            piece = self.pieces[e.label]
            self.connections += [
                (a, "output", b, ports[0] if ports else "input", "") for a, b, *ports in piece.inner
            ]
            arriving: dict[Inlet, list[tuple[Outlet, str, str]]] = {}
            for k, source in enumerate(e.sources):
                self.connect(e, k, source, arriving)
            for k in range(piece.needs):
                for inlet in piece.inlets[k] if k < len(piece.inlets) else ():
                    arriving.setdefault(inlet, [])
            for inlet, sources in arriving.items():
                self.join(e, inlet, sources)

    def connect(
        self, e: Foreign, k: int, s: Source, arriving: dict[Inlet, list[tuple[Outlet, str, str]]]
    ) -> None:
        """Connect one input of the file to its targets, and report it."""
        piece, origin = self.pieces[e.label], f"{s.label}.{s.component}" if s.component else s.label
        inlets = (
            piece.inlets[0 if piece.sums else k]
            if piece.inlets and (piece.sums or k < len(piece.inlets))
            else []
        )
        source = self.pieces.get(s.label)
        if source is None:
            self.drop(e, origin, "there is no such element")
            return
        outlet = source.outlets.get(s.component) if s.component else next(iter(source.outlets.values()), None)
        if outlet is None:
            self.drop(
                e,
                origin,
                f"{s.label!r} gives no {s.component!r} here; it gives {', '.join(source.outlets)}",
            )
            return
        if not inlets:
            self.lines.append(
                Line(
                    e.label,
                    "connection",
                    origin,
                    "carried",
                    f"without effect, as in {self.tool}: {e.kind} does not read its input {k + 1}",
                )
            )
            return
        if any(not self.compatible(outlet.dims, inlet.dims) for inlet in inlets):
            sizes = " into ".join(
                str([1 if a is None else a.samples for a in dims]) for dims in (outlet.dims, inlets[0].dims)
            )
            self.drop(e, origin, f"its size does not fit: {sizes}")
            return
        for inlet in inlets:
            read = source.outlets.get(inlet.component, outlet)
            arriving.setdefault(inlet, []).append((read, self.reads(read, s.label, e.label), s.label))
        self.lines.append(Line(e.label, "connection", origin, "carried"))

    def reads(self, outlet: Outlet, source: str, target: str) -> str:
        """Return `reads` of a connection, from the order of its ends."""
        before = self.place[source] < self.place[target]
        if outlet.state:
            return "current" if before else "previous"
        if before or outlet.still or source in self.noisy:
            return ""
        return "delayed"

    def join(self, e: Foreign, inlet: Inlet, sources: list[tuple[Outlet, str, str]]) -> None:
        """Join the sources of one inlet, each with the axes it needs; without a source the input is zero."""
        if not sources:
            name = self.names.new(f"nothing to {inlet.name}")
            self.extra.append(Boost(name, axes(inlet.dims), 0.0))
            self.connections.append((name, "output", inlet.name, inlet.port, ""))
            self.lines.append(
                Line(
                    e.label,
                    "connection",
                    "input",
                    self.without_input,
                    "nothing is connected to it; zero arrives",
                )
            )
            return
        whole = any(outlet.dims == inlet.dims for outlet, *_ in sources)
        times = Counter((outlet.name, outlet.port, reads) for outlet, reads, _ in sources)
        for k, (outlet, reads, source) in enumerate(sources):
            name, port = outlet.name, outlet.port
            count = times.pop((name, port, reads), 0)
            if not count:
                continue  # counted with the first of its kind
            if reads == "delayed" and (
                outlet.initial or self.rings.get(e.label, -1) == self.rings.get(source, -2)
            ):
                name, port, reads = self.delay(outlet), "output", "previous"
            renamed = _fits(outlet.dims, inlet.dims) != axes(outlet.dims)
            if renamed or (k == 0 and inlet.whole and not whole):
                through = self.names.new(f"{outlet.name} to {inlet.name}")
                self.extra.append(self.adapter(through, outlet.dims, inlet.dims))
                self.connections.append((name, port, through, "input", reads))
                name, port, reads = through, "output", ""
            if count > 1:
                repeated = self.names.new(f"{outlet.name} {count} times to {inlet.name}")
                self.extra.append(Gain(float(count), name=repeated))
                self.connections.append((name, port, repeated, "input", reads))
                name, port, reads = repeated, "output", ""
            self.connections.append((name, port, inlet.name, inlet.port, reads))

    def compatible(self, source: Dims, target: Dims) -> bool:
        """Return whether one size can be expanded to another, dimension by dimension."""
        longer = max(len(source), len(target))
        pairs = zip(
            source + (None,) * (longer - len(source)), target + (None,) * (longer - len(target)), strict=True
        )
        return all(a is None or (b is not None and shape((a,)) == shape((b,))) for a, b in pairs)

    def adapter(self, name: str, source: Dims, target: Dims) -> Element:
        """Return the element between a source and an inlet of other axes."""
        return projection(name, axes(source), target, _fits(source, target))

    def delay(self, outlet: Outlet) -> str:
        """Return a register that delays an outlet by one step.

        It is needed where it closes a loop of couplings, whose axes must be stated, and where it does not
        begin with zero.
        """
        key = (outlet.name, outlet.port)
        if key not in self.delays:
            self.delays[key] = self.names.new(f"{outlet.name} before")
            self.extra.append(Delay(axes(outlet.dims), outlet.initial, name=self.delays[key]))
            self.connections.append((*key, self.delays[key], "input", ""))
        return self.delays[key]

    def _rings(self) -> dict[str, int]:
        """Return a number for each element that follows its inputs in the same instant; a loop shares one."""
        followers = [
            e for e in self.elements if not any(o.state for o in self.pieces[e.label].outlets.values())
        ]
        number = {e.label: k for k, e in enumerate(followers)}
        pairs = [
            (number[s.label], number[e.label]) for e in followers for s in e.sources if s.label in number
        ]
        rows, columns = zip(*pairs, strict=True) if pairs else ((), ())
        graph = coo_array((np.ones(len(pairs)), (rows, columns)), shape=(len(followers), len(followers)))
        _, components = connected_components(graph, connection="strong")
        return {label: int(components[k]) for label, k in number.items()}

    def drop(self, e: Foreign, source: str, why: str) -> None:
        """Report a connection that is not made."""
        self.lines.append(Line(e.label, "connection", source, "dropped", why))

    def _noisy(self) -> set[str]:
        """Return elements of noise alone, all of whose readers come before them.

        Noise of this step and noise of the last step are equivalent for their readers, so they need no
        register.
        """
        noisy: set[str] = set()
        for e in self.elements:
            noise = any(o.noise for o in self.pieces[e.label].outlets.values())
            chained = (
                bool(e.sources)
                and self.pieces[e.label].passes_noise
                and all(s.label in noisy for s in e.sources)
            )
            if noise or chained:
                noisy.add(e.label)
        return {
            n
            for n in noisy
            if all(self.place[t] < self.place[n] for t in self.feeds.get(n, ()) if t not in noisy)
        }


def _fits(source: Dims, target: Dims) -> tuple[Axis | None, ...]:
    """Return the axes of one size among those of another."""
    return tuple(b for a, b in zip(source, target, strict=False) if a is not None)
