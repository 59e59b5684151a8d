"""Write the learned values of a session to its model."""

from __future__ import annotations

import numpy as np

from deodar.errors import ParameterError
from deodar.model.model import Model
from deodar.session.snapshot import SessionSnapshot


def learned(snapshot: SessionSnapshot) -> dict[str, np.ndarray]:
    """Return the values that elements have learned (weights, traces, gains).

    The keys are the id of the element and the parameter for which the value is an initial value:
    `ID.PARAMETER`.
    """
    found: dict[str, np.ndarray] = {}
    for entry in snapshot.document.entries:
        if entry.element.stateful:
            for name, value in entry.element.learned_parameters(snapshot.states[entry.id][0]).items():
                found[f"{entry.id}.{name}"] = np.array(value)
    return found


def keep(snapshot: SessionSnapshot, model: Model) -> list[str]:
    """Write learned values to a model as initial values; return the paths of the parameters.

    All values are one step of undo.

    Raises:
        ParameterError: the model no longer has one of the elements.
    """
    by = model.document.by_id()
    here = snapshot.document.by_id()
    values: dict[str, np.ndarray] = {}
    for place, value in learned(snapshot).items():
        ident, name = place.split(".", 1)
        if ident not in by:
            raise ParameterError(
                "was learned, and is no longer in the model",
                where=here[ident].path,
                fix="Undo its removal: model.undo()",
            )
        values[f"{by[ident].path}.{name}"] = value
    model.set(values)
    return list(values)
