"""What an element of the file becomes: elements of ours, where its inputs go, and where its components are
read.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.project import Project
from deodar.element import Element
from deodar.importers.cosivina.file import Foreign, Simulator
from deodar.importers.cosivina.names import FreeNames
from deodar.importers.cosivina.sizes import Dimensions, Dims, output_size
from deodar.importers.cosivina.values import Values
from deodar.importers.report import Verdict
from deodar.numerics.axes import Axis


@dc.dataclass(frozen=True)
class Inlet:
    """Where an input goes: an element of ours and its port, the dimensions that may arrive, whether all of
    them must, and, where it is not the one that the file names, the component that is read.
    """

    name: str
    dims: Dims
    port: str = "input"
    whole: bool = False
    component: str = ""


@dc.dataclass(frozen=True)
class Outlet:
    """Where a component is read.

    Attributes:
        name: an element of ours.
        port: its output port.
        dims: dimensions of what it gives.
        state: whether it shows a state; otherwise it follows its inputs in the same instant.
        still: whether cosivina sets it when it is initialised, and never again.
        noise: whether it is made of noise alone.
        initial: what cosivina sets it to when it is initialised.
    """

    name: str
    dims: Dims
    port: str = "output"
    state: bool = False
    still: bool = False
    noise: bool = False
    initial: float = 0.0


@dc.dataclass
class Piece:
    """The counterpart of one element.

    Attributes:
        elements: ours, the one that carries the label first.
        inlets: for each input of the file, where it goes; with `sums`, all go to the first.
        outlets: by component; the first is the default.
        inner: connections among `elements`, by name: (source, target) or (source, target, port).
        sums: whether any number of inputs is added up.
        elsewhere: where components are found that no outlet gives, in words.
        needs: how many inputs it cannot do without.
        verdict, why: what the report says of the element itself.
    """

    elements: list[Element] = dc.field(default_factory=list[Element])
    inlets: list[list[Inlet]] = dc.field(default_factory=list[list[Inlet]])
    outlets: dict[str, Outlet] = dc.field(default_factory=dict[str, Outlet])
    inner: list[tuple[str, ...]] = dc.field(default_factory=list[tuple[str, ...]])
    elsewhere: dict[str, str] = dc.field(default_factory=dict[str, str])
    sums: bool = False
    needs: int = 0
    verdict: Verdict = "carried"
    why: str = ""


class SourceElement:
    """What translating one element needs to know: its parameters, the axes, the step, who reads it, and what
    was said on the way.
    """

    def __init__(
        self,
        simulator: Simulator,
        dims: Dimensions,
        element: Foreign,
        asked: set[str],
        names: FreeNames,
        bugs: bool,
    ) -> None:
        self.simulator = simulator
        self.step = simulator.step
        self.element = element
        self.label = element.label
        self.values = Values(element)
        self.asked = asked
        self.reproduce = bugs
        self.met: list[str] = []
        self._dims = dims
        self._names = names

    def dims(self, component: str = "") -> Dims:
        """Dimensions of an output."""
        return self._dims.of(output_size(self.element, component))

    def of(self, counts: Sequence[int]) -> Dims:
        """The dimensions of a size."""
        return self._dims.of(counts)

    def source(self, k: int) -> Dims | None:
        """Dimensions of what an input brings, as its source declares them; None where there is no such
        input.
        """
        if k >= len(self.element.sources):
            return None
        s = self.element.sources[k]
        found = self.simulator.by_label.get(s.label)
        passed: set[str] = set()
        while (
            found is not None
            and found.kind == "HebbianConnection"
            and len(found.sources) > 1
            and found.label not in passed
        ):
            passed.add(found.label)  # its size is that of its second input, and not in the file
            s = found.sources[1]
            found = self.simulator.by_label.get(s.label)
        return None if found is None else self._dims.of(output_size(found, s.component))

    def named(self, what: str) -> str:
        """A name of its own for a further element of ours: the label and what it is."""
        return self._names.new(f"{self.label} {what}")

    def bug(self, what: str) -> bool:
        """Whether a known error of cosivina, which this element touches, is to be reproduced."""
        self.met.append(f"{self.label}: {what}; {'reproduced' if self.reproduce else 'corrected'}")
        return self.reproduce


def axes(dims: Dims) -> tuple[Axis, ...]:
    """The axes among the dimensions."""
    return tuple(a for a in dims if a is not None)


def projection(
    name: str, source: Sequence[Axis], target: Dims, places: Sequence[Axis | None], reduce: str = "sum"
) -> Project:
    """A projection in which each axis of the source becomes the axis of the same place, or is added up where
    that is None.
    """
    here = axes(target)
    names = {
        a.name: b.name for a, b in zip(source, places, strict=True) if b is not None and a.name != b.name
    }
    # an axis that is added up must not be taken for one of the target's
    names |= {
        a.name: f"{a.name} added up"
        for a, b in zip(source, places, strict=True)
        if b is None and a.name in [c.name for c in here]
    }
    return Project(here, reduce, names, name=name)


class Unfit(ValueError):
    """Raised where an element cannot be translated; says why."""
