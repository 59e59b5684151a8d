"""Connections of the document, through the elements that an importer puts between two elements of a file.

Such elements (a projection that renames or expands, a factor for an input that is listed twice, a register
for a value of the previous step, a zero for a missing input) state in the document what the size, the list of
inputs and the order of elements state in a file. They are recognised by their names and by what they do.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping

from deodar.couplings.arithmetic import Gain
from deodar.couplings.delays import Delay
from deodar.couplings.projections import Project
from deodar.elements.stimuli import Boost
from deodar.model.document import Connection, Document, Entry
from deodar.model.resolve import Node
from deodar_interop.exporters.cosivina.layout import layout


@dc.dataclass(frozen=True)
class Traced:
    """A connection and its origin.

    Attributes:
        source, port: the element and port that it begins at.
        reads: what it reads there.
        delayed: whether a register delays it by a step.
        count: how often the file lists it.
        fits: whether its axes fit into the target's without a conversion.
    """

    source: str
    port: str
    reads: str
    delayed: bool = False
    count: int = 1
    fits: bool = False


class Wires:
    """The connections of a document, and the elements that a file does not list."""

    def __init__(self, doc: Document, nodes: Mapping[str, Node]) -> None:
        self.doc = doc
        self.nodes = nodes
        self.by = doc.by_id()
        self.into: dict[tuple[str, str], list[Connection]] = {}
        self.out: dict[str, list[Connection]] = {}
        for c in doc.connections:
            self.into.setdefault((c.target, c.target_port), []).append(c)
            self.out.setdefault(c.source, []).append(c)
        self.extra: set[str] = set()
        for kind, test in ((Delay, self._register), (Gain, self._factor), (Project, self._fitting)):
            self.extra |= {e.id for e in doc.entries if type(e.element) is kind and test(e)}
        self.extra |= {e.id for e in doc.entries if isinstance(e.element, Boost) and self._nothing(e)}

    def trace(self, c: Connection) -> Traced | None:
        """Return the origin of a connection; None for one that carries nothing."""
        if c.source not in self.extra:
            return Traced(c.source, c.source_port, c.reads)
        element = self.by[c.source].element
        if isinstance(element, Boost):
            return None
        found = self.trace(self.into[c.source, "input"][0])
        if found is None:
            return None
        if isinstance(element, Delay):
            return dc.replace(found, delayed=True, fits=True)
        if isinstance(element, Gain):
            return dc.replace(found, count=int(element.factor))
        return dc.replace(found, fits=True)

    # ------------------------------------------------------------------------------------- what is recognised

    def _nothing(self, e: Entry) -> bool:
        element = e.element
        assert isinstance(element, Boost)
        out = self.out.get(e.id, [])
        return (
            not element.amplitude
            and element.windows is None
            and len(out) == 1
            and self._named(e, f"nothing to {self._name(out[0].target)}")
        )

    def _register(self, e: Entry) -> bool:
        """A register of the value of the previous step, which begins with zero or the border of a shift."""
        c = self._only(e)
        element = e.element
        assert isinstance(element, Delay)
        if c is None or not self._named(e, f"{self._name(c.source)} before"):
            return False
        border = f"{self._name(c.source)} border"
        if element.initial and not any(self._named(other, border) for other in self.doc.entries):
            return False
        return not self.nodes[c.source].shows_state(c.source_port)

    def _factor(self, e: Entry) -> bool:
        c, out = self._only(e), self.out.get(e.id, [])
        element = e.element
        assert isinstance(element, Gain)
        if c is None or len(out) != 1 or element.factor < 2 or not element.factor.is_integer():
            return False
        names = {self._name(i) for i in self._behind(c.source)}
        into = self._name(out[0].target)
        return any(self._named(e, f"{name} {element.factor:.0f} times to {into}") for name in names)

    def _fitting(self, e: Entry) -> bool:
        """A projection that only renames axes, or adds some: what sizes of a file that fit state."""
        c, out = self._only(e), self.out.get(e.id, [])
        element = e.element
        assert isinstance(element, Project)
        if c is None or len(out) != 1 or element.reduce != "sum":
            return False
        into = out[0].target
        into = self.out[into][0].target if into in self.extra else into
        name = self._name(into)
        if not any(self._named(e, f"{self._name(i)} to {name}") for i in self._behind(c.source)):
            return False
        node = self.nodes[e.id]
        here, there = layout(node.ins["input"]), layout(node.outs["output"])
        pairs = list(zip(here, there, strict=False))
        return len([a for a in here if a is not None]) == len(
            [a for a, b in pairs if a is not None and b is not None and a.samples == b.samples]
        )

    def _behind(self, ident: str) -> list[str]:
        """Return an element, and those behind it if it is an extra one."""
        out = [ident]
        while out[-1] in self.extra or isinstance(self.by[out[-1]].element, (Project, Delay)):
            c = self._only(self.by[out[-1]])
            if c is None or c.source in out:
                break
            out.append(c.source)
        return out

    def _only(self, e: Entry) -> Connection | None:
        found = self.into.get((e.id, "input"), [])
        return found[0] if len(found) == 1 else None

    def _name(self, ident: str) -> str:
        return self.by[ident].names[-1]

    def _named(self, e: Entry, name: str) -> bool:
        return re.fullmatch(re.escape(name) + r"( \d+)?", e.names[-1]) is not None
