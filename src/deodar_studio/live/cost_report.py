"""The published costs of a running model."""

from __future__ import annotations

import dataclasses as dc

from deodar.errors import DeodarError, Problem
from deodar.session.cost import StepCost


@dc.dataclass(frozen=True)
class CostReport:
    """Cost of elements: whether a measurement runs, the last result, and why a measurement failed."""

    measuring: bool = False
    costs: StepCost | None = None
    problems: tuple[Problem, ...] = ()


def said(error: BaseException) -> tuple[Problem, ...]:
    """Return the problems of an error of any class."""
    return (
        tuple(error.problems)
        if isinstance(error, DeodarError)
        else (Problem("", f"{type(error).__name__}: {error}"),)
    )
