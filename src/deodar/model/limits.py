"""The longest Euler step that an element allows."""

from __future__ import annotations

from collections.abc import Iterator

from deodar.element import Element
from deodar.errors import Problem
from deodar.leaves import step_limits


def too_long(where: str, element: Element, dt: float, every: int, unit: str) -> Iterator[Problem]:
    """Report an Euler step that is too long for an element; `check` and runs use the same sentence.

    Args:
        where: path of the element.
        element: the element.
        dt: Euler step of the model.
        every: step of the element in ticks, as a multiple of `dt`.
        unit: unit of time of the document.
    """
    for limit in step_limits(element):
        if dt * every > limit.longest * (1 + 1e-9):
            better = "smaller" if limit.role == "rate" else "larger"
            sentence = f"the step of {dt * every:g} {unit} is longer than {limit}"
            yield Problem(
                where,
                sentence,
                f"Use dt <= {limit.longest / every:g}, better a tenth of it, or a {better} {limit.path}",
            )
