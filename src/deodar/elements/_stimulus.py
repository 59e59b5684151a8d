"""The contract of a stimulus: a pattern over axes, on for ever or in windows of time."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.windows import Window, gate
from deodar.parameters import Recompile


@dataclass(frozen=True)
class Stimulus(Element):
    """s(x, t): a pattern times a gate over time; subclasses give the pattern."""

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the pattern")] = ()
    windows: Annotated[Sequence[Window], Recompile(meaning="when it is on; without windows always")] = dc.field(default=(), kw_only=True)

    inputs: ClassVar[tuple[str, ...]] = ()
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ()}

    def pattern(self, at: Setting) -> Any:
        """The stimulus while it is on, over its axes."""
        raise NotImplementedError

    def misfits(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        for k, w in enumerate(self.windows):
            if w.stop < w.start:
                yield (
                    f"windows.{k} ends at {w.stop:g}, before it begins at {w.start:g}, so it is never on",
                    f"Write start and stop: ({w.stop:g}, {w.start:g}), or ({w.start:g}, {w.start + w.stop:g}) if {w.stop:g} is its duration",
                )

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        for k, w in enumerate(self.windows):
            if w.stop == w.start:
                yield f"windows.{k} begins and ends at {w.start:g}, so it is never on", "Give it a stop after its start, or leave it out"

    def steady(self) -> bool:
        return not self.windows

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": tuple(self.axes)}

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        return {"output": self.pattern(at) * gate(self.windows, time, at.dtype)}
