"""The state of a session at one moment, stored by element, so that another program can use it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

import numpy as np

from deodar.compiler.arguments import ProgramState
from deodar.compiler.executable import Executable
from deodar.model.document import Document
from deodar.numerics.pytree import PyTree
from deodar.session.clock import Clock
from deodar.session.exchange import WorldState
from deodar.session.run import Run, host

StateRow = Mapping[str, np.ndarray]
"""The state of one element: its arrays by name."""


@dc.dataclass(frozen=True)
class SessionSnapshot:
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


def rows(program: Executable, state: ProgramState) -> dict[str, tuple[StateRow, StateRow]]:
    """Return the state of every element by id: the visible one, and the one that is held until it is due.

    Both are the same for elements that run at every tick.
    """
    here = host(state)
    out: dict[str, tuple[StateRow, StateRow]] = {}
    for ident, (g, r) in program.plan.row.items():
        shown = {name: values[r] for name, values in here["groups"][g].items()}
        held = {name: values[r] for name, values in here["held"].get(str(g), here["groups"][g]).items()}
        out[ident] = (shown, held)
    return out


def fill(run: Run, states: Mapping[str, tuple[StateRow, StateRow]]) -> None:
    """Copy states by id into the present program, for elements whose states have the same shapes.

    Other elements start at their initial states. Noise follows from seed and tick.
    """
    fresh, run.keys = run.program.init(run.values, run.seed, run.trials)
    state = host(fresh)
    for ident, (g, r) in run.program.plan.row.items():
        if ident in states:
            shown, held = states[ident]
            _copy_row(shown, state["groups"][g], r)
            if str(g) in state["held"]:
                _copy_row(held, state["held"][str(g)], r)
    run.state = state
    run.forget()


def _copy_row(source: StateRow, target: PyTree, row: int) -> None:
    for name, values in source.items():
        if name in target and target[name].shape[1:] == values.shape:
            target[name][row] = values
