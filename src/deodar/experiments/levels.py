"""Whether trials of one batch may differ in a parameter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.compiler.driven import driven
from deodar.compiler.plan import cost
from deodar.errors import ParameterError
from deodar.experiments.actions import Action, Push
from deodar.leaves import leaves
from deodar.model import find
from deodar.model.document import Document
from deodar.parameters import real, show


def acted(
    doc: Document,
    actions: Sequence[Action],
    pushes: Mapping[Push, str],
    values: Mapping[str, Sequence[float]],
    trials: int,
) -> dict[str, np.ndarray]:
    """Return the parameters in which the trials of one batch differ, or that actions change, each with the
    values of the trials at the start.

    Args:
        doc: the document, with the boosts of pushes.
        actions: the actions on each trial.
        pushes: for each push whose time is not the same in all trials, the path of its boost.
        values: for parameter paths the value of each trial.
        trials: number of trials.

    Raises:
        ParameterError: an action sets a parameter that cannot change in one copy of a batch.
    """
    columns = {path: np.array(numbers, float) for path, numbers in values.items()}
    for path, column in columns.items():
        if column.shape != (trials,):
            raise ParameterError(
                f"needs a number for each of the {trials} trials, not {show(values[path])}", where=path
            )
    for path, numbers in set_values(actions).items():
        if not swept(doc, path, [*columns.get(path, [find.value(doc, path)]), *numbers]):
            raise ParameterError(
                "cannot be set in one trial of a batch: changing it makes another program",
                where=path,
                fix="Run the trials one by one: dd.Trials(..., together=False)",
            )
        columns.setdefault(path, np.full(trials, float(find.value(doc, path))))
    return columns | {f"{boost}.amplitude": np.zeros(trials) for boost in pushes.values()}


def set_values(actions: Sequence[Action]) -> dict[str, list[Any]]:
    """Return the parameters that actions set, and the values that they get."""
    out: dict[str, list[Any]] = {}
    for action in actions:
        for path, value in action.sets():
            out.setdefault(path, []).append(value)
    return out


def swept(doc: Document, path: str, values: Iterable[object]) -> bool:
    """Return whether copies of one batch may have these values.

    They may if the values are numbers of live parameters, and none of them switches a term off. Copies that
    differ in a parameter that rebuilds, such as a kernel's width, would each need their own matrices.
    """
    numbers = [real(v) for v in values]
    if any(v is None for v in numbers):
        return False
    try:
        driven_leaves = driven(doc, path)
    except ParameterError:
        return False
    by = doc.by_id()
    declared = [
        next(p for leaf, _, p in leaves(by[i].element) if leaf == inner) for i, inner in driven_leaves
    ]
    return not any(cost(p) != "live" or (p.off and v == p.neutral) for p in declared for v in numbers)
