"""Graph of a picture: items, wires between them, and frames around groups, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from deodar.numerics.axes import Axes
from deodar.numerics.signs import Sign

ItemForm = Literal["field", "node", "source", "sensor", "motor", "coupling", "missing", "group"]
GroupPath = tuple[str, ...]


@dataclass(frozen=True)
class Item:
    """One element, or a group that is drawn as one box.

    Attributes:
        id: its id, which wires name.
        form: its shape.
        name: its name.
        kind: its kind in words; empty if the form shows it.
        axes: the axes over which it is defined.
        recurrence: signs of its interactions with itself, drawn as loops.
        group: names of the groups around it.
        every: ticks of its own step.
        axes_shown: whether its axes are written; not if all connected items have the same axes.
    """

    id: str
    form: ItemForm
    name: str
    kind: str = ""
    axes: Axes = ()
    recurrence: tuple[Sign, ...] = ()
    group: GroupPath = ()
    every: int = 1
    axes_shown: bool = True


@dataclass(frozen=True)
class Wire:
    """One connection, with the couplings on it.

    Attributes:
        source, target: ids of items.
        source_port, target_port: names of the ports; empty for the default port.
        sign: "+", "-" or "±".
        captions: one line of text for each coupling on the way.
        delayed: whether it is read one step later.
    """

    source: str
    target: str
    source_port: str = ""
    target_port: str = ""
    sign: Sign = "+"
    captions: tuple[str, ...] = ()
    delayed: bool = False


@dataclass(frozen=True)
class Graph:
    """The graph of a picture.

    Attributes:
        name: title of the picture, for readers of the screen.
        groups: every group, with the name of the template that it stays linked to, or "".
        places: upper left corners of items that have a given place; used where all have one.
    """

    name: str
    items: tuple[Item, ...]
    wires: tuple[Wire, ...]
    groups: Mapping[GroupPath, str] = field(default_factory=dict[GroupPath, str])
    places: Mapping[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
