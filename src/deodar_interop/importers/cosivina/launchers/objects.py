"""What a script builds: simulators of elements, and windows with plots and controls."""

from __future__ import annotations

import dataclasses as dc
from typing import Any


@dc.dataclass(frozen=True)
class MissingValue:
    """A value that is not known, and why."""

    why: str


@dc.dataclass(frozen=True, eq=False)
class ClassCall:
    """A call of a class that is not a simulator or a window: an element, a control, a plot.

    Attributes:
        name: the class.
        arguments: its arguments; some may be `MissingValue`.
        line: its line in the script.
    """

    name: str
    arguments: tuple[Any, ...]
    line: int


@dc.dataclass(eq=False)
class BuiltElement:
    """An element of a simulator.

    Attributes:
        label: its label.
        kind: its class.
        values: its parameters.
        inputs: labels and components of its sources.
    """

    label: str
    kind: str
    values: dict[str, Any]
    inputs: list[tuple[str, str]] = dc.field(default_factory=list[tuple[str, str]])


@dc.dataclass(eq=False)
class BuiltSimulator:
    """A simulator: its elements in their order, the step and the time at the start."""

    step: float = 1.0
    start: float = 0.0
    elements: dict[str, BuiltElement] = dc.field(default_factory=dict[str, BuiltElement])


@dc.dataclass(eq=False)
class BuiltWindow:
    """A window: the simulator that it shows, its controls and its plots."""

    simulator: BuiltSimulator | None = None
    controls: list[ClassCall] = dc.field(default_factory=list[ClassCall])
    plots: list[ClassCall] = dc.field(default_factory=list[ClassCall])
