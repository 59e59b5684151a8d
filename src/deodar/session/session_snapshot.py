"""The state of a session at one moment, stored by element, so that another program can use it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any

import numpy as np

from deodar.compiler.arguments import ProgramState
from deodar.compiler.executable import Executable
from deodar.model.document import Document
from deodar.session.clock import Clock
from deodar.session.exchange import WorldState
from deodar.summary import Summarised, Summary

StateRow = Mapping[str, np.ndarray]
"""The state of one element: its arrays by name."""


@dc.dataclass(frozen=True, repr=False)
class SessionSnapshot(Summarised):
    """The whole state of a session at one moment.

    Attributes:
        document: the document with its parameters.
        states: for each element by id its visible state, and the state that is not visible yet (of elements
            with a step of their own).
        clock: tick, time and dt.
        seed: seed of the noise, which is determined by seed and tick.
        precision: float32 or float64.
        world: state of the world; None: the session had none.
    """

    document: Document
    states: Mapping[str, tuple[StateRow, StateRow]]
    clock: Clock
    seed: int
    precision: str
    world: WorldState | None = None

    def _summary(self) -> Summary:
        doc = self.document
        return Summary(f"Snapshot of {doc.name!r} at {self.clock.time:g} {doc.time_unit}, seed {self.seed}")


def rows(
    program: Executable, state: ProgramState, copy: tuple[int, ...] = ()
) -> dict[str, tuple[StateRow, StateRow]]:
    """Return the state of every element by id: the visible one, and the one that is held until it is due.

    Both are the same for elements that run at every tick. The arrays of `state` are on the host; `copy` is
    the index of a copy in a batch.
    """
    out: dict[str, tuple[StateRow, StateRow]] = {}
    arrays_of: Any = state
    for ident, (g, r) in program.plan.row.items():
        visible, coming = (
            {name: values[(*copy, r)] for name, values in arrays.items()}
            for arrays in (arrays_of["groups"][g], arrays_of["held"].get(str(g), arrays_of["groups"][g]))
        )
        out[ident] = (visible, coming)
    return out
