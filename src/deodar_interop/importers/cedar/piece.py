"""The translation of one step: deodar elements, the targets of its input slots, and the ports of its output
slots.
"""

from __future__ import annotations

import dataclasses as dc

from deodar.element import Element
from deodar.importers.report import Verdict
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.values import StepValues


@dc.dataclass(frozen=True)
class InputSlot:
    """The target of an input slot: a deodar element and its port."""

    name: str
    port: str = "input"


@dc.dataclass(frozen=True)
class OutputSlot:
    """The port of an output slot.

    Attributes:
        name: name of a deodar element.
        dims: size of the port.
        port: its output port.
        state: whether cedar gives the value after the update, as deodar's port does at the end of a step;
            otherwise the value is computed from the inputs or from the state before the update.
        doubt: what is not documented of cedar's value; "" if nothing.
    """

    name: str
    dims: Counts
    port: str = "output"
    state: bool = False
    doubt: str = ""


@dc.dataclass
class StepPiece:
    """The translation of one step.

    Attributes:
        elements: deodar elements; the first has the step's name.
        inlets: for each input slot the targets of its connections, in their order; a slot of `sums` has one
            entry for all.
        outlets: ports by output slot.
        inner: connections among `elements`, by name: source, target, and where they differ from `input`, ""
            and `output` the target's port, what it reads, and the source's port.
        sums: input slots that add up any number of connections.
        wanted: size that an input slot requires, with one number allowed in its place if it is in `sums`.
        needs: input slots without which cedar does not run the step.
        stops: why cedar does not run the step, which then gives nothing; "" if it does.
        fails: why the step ends with an exception when it runs, and gives 0; "" if it does not.
        verdict, why: verdict and reason of the step itself in the report.
    """

    elements: list[Element] = dc.field(default_factory=list[Element])
    inlets: dict[str, list[list[InputSlot]]] = dc.field(default_factory=dict[str, list[list[InputSlot]]])
    outlets: dict[str, OutputSlot] = dc.field(default_factory=dict[str, OutputSlot])
    inner: list[tuple[str, ...]] = dc.field(default_factory=list[tuple[str, ...]])
    sums: frozenset[str] = frozenset()
    wanted: dict[str, Counts] = dc.field(default_factory=dict[str, Counts])
    needs: tuple[str, ...] = ()
    stops: str = ""
    fails: str = ""
    verdict: Verdict = "carried"
    why: str = ""


class Refused(ValueError):
    """Raised if cedar does not run a step; the message is cedar's reason."""


def sizes(values: StepValues, default: int, most: int) -> Counts:
    """Return the size that `dimensionality` and `sizes` state together."""
    count = values.whole("dimensionality", 2, 0, most)
    if not count:
        if "sizes" in values.body:
            values.say("sizes", "carried", "none for one number")
        return ()
    dims = tuple(int(n) for n in values.numbers("sizes", default, count, 1, 1e6))
    # a matrix with one row or one column has one dimension in cedar, and one with both none
    return tuple(n for n in dims if n > 1) if count <= 2 else dims
