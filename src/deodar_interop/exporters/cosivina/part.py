"""One element of the file that is written, its inputs, and the outputs that other elements read."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from deodar_interop.importers._piece import Dims

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
