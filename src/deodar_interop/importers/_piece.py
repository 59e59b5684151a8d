"""The translation of one element of a file: deodar elements, the targets of its inputs, and the ports of its
components.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.couplings.projections import Project
from deodar.element import Element
from deodar.importers.report import Verdict
from deodar.numerics.axes import Axis

Dims = tuple[Axis | None, ...]
"""The axis of each dimension; None where it has one sample."""


@dc.dataclass(frozen=True)
class Inlet:
    """The target of an input: a deodar element and its port, the valid dimensions, whether the input must
    have all of them, and the component to read if it differs from the file's.
    """

    name: str
    dims: Dims
    port: str = "input"
    whole: bool = False
    component: str = ""


@dc.dataclass(frozen=True)
class Outlet:
    """The port that shows a component.

    Attributes:
        name: name of a deodar element.
        port: its output port.
        dims: dimensions of the port.
        state: whether it shows a state; otherwise it follows its inputs in the same instant.
        still: whether the tool sets it at the start only.
        noise: whether it consists of noise alone.
        initial: value that the tool sets at the start.
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
    """The translation of one element.

    Attributes:
        elements: deodar elements; the first has the label.
        inlets: for each input of the file its target; with `sums`, all inputs go to the first.
        outlets: ports by component; the first is the default.
        inner: connections among `elements`, by name: (source, target) or (source, target, port).
        sums: whether the element adds up any number of inputs.
        elsewhere: descriptions of where to find components without an outlet.
        needs: smallest number of inputs.
        passes_noise: whether the output is noise alone if all inputs are.
        verdict, why: verdict and reason of the element itself in the report.
    """

    elements: list[Element] = dc.field(default_factory=list[Element])
    inlets: list[list[Inlet]] = dc.field(default_factory=list[list[Inlet]])
    outlets: dict[str, Outlet] = dc.field(default_factory=dict[str, Outlet])
    inner: list[tuple[str, ...]] = dc.field(default_factory=list[tuple[str, ...]])
    elsewhere: dict[str, str] = dc.field(default_factory=dict[str, str])
    sums: bool = False
    needs: int = 0
    passes_noise: bool = False
    verdict: Verdict = "carried"
    why: str = ""


def axes(dims: Dims) -> tuple[Axis, ...]:
    """Return the axes among the dimensions."""
    return tuple(a for a in dims if a is not None)


def projection(
    name: str, source: Sequence[Axis], target: Dims, places: Sequence[Axis | None], reduce: str = "sum"
) -> Project:
    """Return a projection in which each axis of the source becomes the axis at its index, or is summed if
    that is None.
    """
    target_axes = axes(target)
    names = {
        a.name: b.name for a, b in zip(source, places, strict=True) if b is not None and a.name != b.name
    }
    # the name of a summed axis must differ from those of the target's axes
    names |= {
        a.name: f"{a.name} added up"
        for a, b in zip(source, places, strict=True)
        if b is None and a.name in [c.name for c in target_axes]
    }
    return Project(target_axes, reduce, names, name=name)


class Unfit(ValueError):
    """Raised if an element cannot be translated; the message is the reason."""
