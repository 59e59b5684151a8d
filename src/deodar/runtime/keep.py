"""What a session has learned, taken into the model it was made from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from deodar.errors import ParameterError
from deodar.model.model import Model

if TYPE_CHECKING:
    from deodar.runtime.session import Session


def learned(session: Session) -> dict[str, np.ndarray]:
    """What elements have learned so far (weights, traces, gains), by the id of the element and the parameter that takes it up."""
    found: dict[str, np.ndarray] = {}
    states = session.snapshot().states
    for entry in session.document.entries:
        if entry.element.stateful:
            for name, value in entry.element.lasting(states[entry.id][0]).items():
                found[f"{entry.id}.{name}"] = np.array(value)
    return found


def keep(session: Session, model: Model) -> list[str]:
    """Write what was learned into a model, as what its elements start from: one change, which `undo` takes back.

    Raises:
        ParameterError: the model no longer has one of the elements.
    """
    by = model.document.by_id()
    here = session.document.by_id()
    values: dict[str, np.ndarray] = {}
    for place, value in learned(session).items():
        ident, name = place.split(".", 1)
        if ident not in by:
            raise ParameterError("was learned, and is no longer in the model", where=here[ident].path, fix="Undo its removal: model.undo()")
        values[f"{by[ident].path}.{name}"] = value
    model.set(values)
    return list(values)
