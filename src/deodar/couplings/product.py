"""The pointwise product."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.registry import register


@register
@dataclass(frozen=True)
class Product(Coupling):
    """One signal gates another, place by place.

    Equation:
        y(x) = input(x) * factor(x); the sums of all connections into either port

    Parameters:
        none.

    Ports:
        input: any axes.
        factor: the axes of `input`; a number gates everywhere alike.
        output: the axes of `input`.

    Reference:
        no reference
    """

    inputs: ClassVar[tuple[str, ...]] = ("input", "factor")
    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input", "factor")}

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        return {"output": inputs["input"] * inputs["factor"]}
