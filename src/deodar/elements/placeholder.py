"""The placeholder for an element that deodar does not have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from deodar.element import Arrays, Element, Setting
from deodar.numerics.axes import Axis
from deodar.registry import register


@register
@dataclass(frozen=True)
class Placeholder(Element):
    """A placeholder that keeps the connections of an imported element without a counterpart in deodar.

    Its output is zero.

    Equation:
        y(x) = 0

    Parameters:
        axes: axes of its ports; none: numbers.
        missing: the element that is missing, and what it computes.

    Ports:
        input: over `axes`; not used.
        output: 0, over `axes`.

    Reference:
        no reference
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    missing: str = ""

    # stateful with a constant state, so that it may close a loop, as the missing element might
    stateful: ClassVar[bool] = True

    def init(self, at: Setting) -> Arrays:
        return {"nothing": at.full(tuple(self.axes), 0.0)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["nothing"]}
