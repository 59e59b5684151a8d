"""What is known of the costs of a running model, for others to look at."""

from __future__ import annotations

import dataclasses as dc

from deodar.errors import DeodarError, Problem
from deodar.session.cost import StepCost


@dc.dataclass(frozen=True)
class Bill:
    """What elements cost: whether it is being measured, what was found last, and why nothing was."""

    measuring: bool = False
    costs: StepCost | None = None
    problems: tuple[Problem, ...] = ()


def said(error: BaseException) -> tuple[Problem, ...]:
    """What an error says, whoever raised it."""
    return (
        tuple(error.problems)
        if isinstance(error, DeodarError)
        else (Problem("", f"{type(error).__name__}: {error}"),)
    )
