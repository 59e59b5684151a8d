"""The file that is being written: its elements, the outputs they show, and the report."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping, Sequence
from typing import Any

from deodar.couplings.convolutions import Interaction
from deodar.couplings.projections import Project
from deodar.element import Element
from deodar.importers.report import Line, Verdict
from deodar.model.document import Document, Entry
from deodar.model.resolve import Node
from deodar.numerics.axes import Axes
from deodar.numerics.kernels.separable import Gaussian, TruncatedGaussian
from deodar.parameters import parameters
from deodar_interop.exporters.cosivina.layout import circular, layout, size, widths
from deodar_interop.exporters.cosivina.tracing import Wires
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers._piece import Dims
from deodar_interop.importers.cosivina.classes.kernels import WHOLE

ListPlace = tuple[int, int]
"""Preferred position in the list of elements: that of the entry of the document, and a position beside it."""


@dc.dataclass(eq=False)
class FilePart:
    """An element of the file.

    Attributes:
        label, kind, values: label, class and parameters.
        place: preferred position in the list.
        links: inputs, in any order; the file lists them by their slots.
        sums: whether it adds up any number of inputs.
    """

    label: str
    kind: str
    values: dict[str, Any]
    place: ListPlace
    links: list[PartLink] = dc.field(default_factory=list["PartLink"])
    sums: bool = False


@dc.dataclass(frozen=True)
class PartOutput:
    """A component that other elements read.

    Attributes:
        part: the element of the file.
        component: name of the component.
        dims: its dimensions, with the axes of the document.
        state: whether the port of the document shows a state.
        free: whether the value is the same before and after the part is computed, or equivalent (noise).
    """

    part: FilePart
    component: str
    dims: Dims
    state: bool = False
    free: bool = False


@dc.dataclass(frozen=True)
class PartInput:
    """An input of a part: its slot, and the dimensions into which a source must fit."""

    part: FilePart
    dims: Dims
    slot: int = 0


@dc.dataclass(frozen=True)
class PartLink:
    """One input of a part.

    Attributes:
        part, component: the source.
        slot: index of the input.
        after: True if the source must be listed after the part, which then reads its value of the previous
            step; False if before; None if the order has no effect.
        dims: dimensions of the source.
    """

    part: FilePart
    component: str
    slot: int
    after: bool | None
    dims: Dims


class Unwritable(ValueError):
    """Raised if cosivina has no counterpart of an element; the message is the reason."""


class Draft:
    """The parts of the file, the outputs that they show and the inputs that they take, by entry and port."""

    def __init__(self, doc: Document, nodes: Mapping[str, Node]) -> None:
        self.doc = doc
        self.nodes = nodes
        self.step, self.start = doc.step, doc.t0
        self.place = {e.id: k for k, e in enumerate(doc.entries)}
        self.labels = {e.id: e.path if e.group else e.names[-1] for e in doc.entries}
        self.names = FreeNames(self.labels.values())
        self.wires = Wires(doc, nodes)
        self.parts: list[FilePart] = []
        self.outlets: dict[tuple[str, str], PartOutput] = {}
        self.inlets: dict[tuple[str, str], list[PartInput]] = {}
        self.claimed: dict[str, str] = dict.fromkeys(self.wires.extra, "")
        self.lines: list[Line] = []

    def followers(self, ident: str, what: str) -> list[Entry]:
        """Return the entries, not claimed yet, that an importer named after an element and a role."""
        label = self.doc.by_id()[ident].names
        pattern = re.compile(re.escape(f"{label[-1]} {what}") + r"( \d+)?")
        return [
            e
            for e in self.doc.entries
            if e.id not in self.claimed and e.group == label[:-1] and pattern.fullmatch(e.names[-1])
        ]

    def readers(self, ident: str, port: str = "output") -> int:
        """Return the number of connections that read a port."""
        return sum(c.source == ident and c.source_port == port for c in self.doc.connections)

    def passes_on(self, ident: str) -> bool:
        """Return whether an element only passes its input on, to kernels that multiply its transform."""
        element, node = self.doc.by_id()[ident].element, self.nodes[ident]
        if not isinstance(element, Project) or element.reduce != "integral" or dict(element.rename):
            return False
        readers = [self.doc.by_id()[c.target] for c in self.wires.out.get(ident, [])]
        return node.ins["input"] == node.outs["output"] and all(
            isinstance(r.element, Interaction)
            and self.endless(r.element, self.nodes[r.id].axes("output"), rings=True)
            for r in readers
        )

    def endless(self, element: Interaction, axes: Axes, rings: bool = False) -> bool:
        """Return whether an interaction is one that a transform of the whole input computes; with `rings`,
        on rings alone.
        """
        kernels = element.kernel
        if len(kernels) != 2 or any(a.step != 1 for a in axes):
            return False
        ends = [circular(axes, k.boundary) for k in kernels]
        whole = [isinstance(k, TruncatedGaussian) and k.cutoff >= WHOLE and not k.least for k in kernels]
        plain = [type(k) is Gaussian and (k.normalized or min(widths(axes, k.sigma)) >= 1) for k in kernels]
        flags = {getattr(k, "normalized", None) for k in kernels}
        if ends[0] != ends[1] or len(flags) > 1:
            return False
        if all(ends[0]):
            return all(whole)
        return not rings and all(w or p for w, p in zip(whole, plain, strict=True))


class Given:
    """An entry of the document that is written: its element, its axes, and where its parts and report lines
    go.
    """

    def __init__(self, draft: Draft, entry: Entry) -> None:
        self.draft = draft
        self.entry = entry
        self.id = entry.id
        self.label = draft.labels[entry.id]
        self.node = draft.nodes[entry.id]
        self.verdict: Verdict = "carried"
        self.reasons: list[str] = []
        self.said: dict[str, Line] = {}
        self.made: list[FilePart] = []
        self.used: list[tuple[str, str]] = []

    @property
    def element(self) -> Element:
        """The element."""
        return self.entry.element

    def dims(self, port: str = "output") -> Dims:
        """Return the dimensions of a port."""
        return layout(self.axes(port))

    def axes(self, port: str = "output") -> Axes:
        """Return the axes of a port."""
        return self.node.axes(port)

    def part(
        self,
        kind: str,
        values: Mapping[str, Any],
        label: str = "",
        sums: bool = False,
        beside: int = 0,
    ) -> FilePart:
        """Add an element to the file; without a label it has that of the entry."""
        name = self.draft.names.new(label) if label else self.label
        part = FilePart(name, kind, dict(values), (self.draft.place[self.id], beside), sums=sums)
        self.made.append(part)
        return part

    def sized(self, kind: str, values: Mapping[str, Any], dims: Dims | None = None, **more: Any) -> FilePart:
        """Add an element with a size, by default that of the output."""
        return self.part(kind, {"size": size(self.dims() if dims is None else dims), **values}, **more)

    def show(
        self,
        part: FilePart,
        port: str = "output",
        component: str = "output",
        *,
        of: str = "",
        dims: Dims | None = None,
        free: bool = False,
    ) -> None:
        """Let a component of a part be what readers of a port read; `of` is an entry that it contains."""
        node = self.draft.nodes[of or self.id]
        state = node.shows_state(port)
        there = layout(node.axes(port)) if dims is None else dims
        self.draft.outlets[of or self.id, port] = PartOutput(part, component, there, state, free)

    def carry(self, part: FilePart) -> None:
        """Let a part take the input of the entry, and show its output."""
        self.take(part)
        self.show(part)

    def take(
        self, part: FilePart, port: str = "input", slot: int = 0, *, of: str = "", dims: Dims | None = None
    ) -> None:
        """Let a part take what is connected to a port."""
        there = layout(self.draft.nodes[of or self.id].axes(port)) if dims is None else dims
        self.draft.inlets.setdefault((of or self.id, port), []).append(PartInput(part, there, slot))

    def inner(
        self,
        part: FilePart,
        source: FilePart,
        *,
        after: bool | None = False,
        dims: Dims | None = None,
    ) -> None:
        """Connect two parts of this entry."""
        part.links.append(PartLink(source, "output", 0, after, self.dims() if dims is None else dims))

    def claim(self, others: Sequence[Entry]) -> None:
        """State that other entries are contained in the parts of this one."""
        for e in others:
            self.draft.claimed[e.id] = self.label

    def say(self, parameter: str, verdict: Verdict, why: str) -> None:
        """Report a parameter that is not carried, or how it is carried."""
        self.said[parameter] = Line(self.entry.path, "parameter", parameter, verdict, why)

    def approximate(self, why: str) -> None:
        """Report that the element is approximated."""
        self.verdict = "approximated"
        self.reasons.append(why)

    def finish(self) -> None:
        """Add the parts and the report lines to the file."""
        draft = self.draft
        draft.parts += self.made
        kinds = ", ".join(dict.fromkeys(p.kind for p in self.made))
        if self.entry.every != 1:
            self.approximate(f"it is computed in every step, not in every {self.entry.every}th")
        why = "; ".join([kinds, *self.reasons])
        kind = type(self.element).__name__
        draft.lines.append(Line(self.entry.path, "element", kind, self.verdict, why))
        for p in parameters(type(self.element)):
            if p.name != "name":
                draft.lines.append(
                    self.said.get(p.name, Line(self.entry.path, "parameter", p.name, "carried"))
                )

    def drop(self, why: str) -> None:
        """Report that the element is not written."""
        for key in [k for k in self.draft.outlets if k[0] == self.id]:
            del self.draft.outlets[key]
        for key in [k for k in self.draft.inlets if k[0] == self.id]:
            del self.draft.inlets[key]
        kind = type(self.element).__name__
        self.draft.lines.append(Line(self.entry.path, "element", kind, "dropped", why))
        self.draft.lines += [
            Line(self.entry.path, "parameter", p.name, "dropped", "its element is not written")
            for p in parameters(type(self.element))
            if p.name != "name"
        ]
