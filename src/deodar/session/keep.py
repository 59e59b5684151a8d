"""Write the learned values of a session to its model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from deodar.element import Element
from deodar.errors import ParameterError
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.session.carry import nodes, nodes_of, put_rows
from deodar.session.run import Run, host
from deodar.session.session_snapshot import SessionSnapshot, StateRow, rows


def learned(snapshot: SessionSnapshot) -> dict[str, np.ndarray]:
    """Return the values that elements have learned (weights, traces, gains).

    The keys are the id of the element and the parameter for which the value is an initial value:
    `ID.PARAMETER`.
    """
    learned_values: dict[str, np.ndarray] = {}
    for entry in snapshot.document.entries:
        if entry.element.stateful:
            for name, value in entry.element.learned_parameters(snapshot.states[entry.id][0]).items():
                learned_values[f"{entry.id}.{name}"] = np.array(value)
    return learned_values


def learned_states(element: Element, state: StateRow) -> list[str]:
    """Return the names of the states of an element from which its learned parameters follow."""
    before = element.learned_parameters(state) if element.stateful else {}

    def follows(name: str) -> bool:
        after = element.learned_parameters({**state, name: state[name] + 1})
        return any(not np.array_equal(after[key], before[key]) for key in before)

    return [name for name in state if follows(name)] if before else []


def with_learned(
    doc: Document,
    learned_rows: Mapping[str, tuple[StateRow, StateRow]],
    states: Mapping[str, tuple[StateRow, StateRow]],
) -> dict[str, tuple[StateRow, StateRow]]:
    """Return states of elements, with those in place of them that elements have learned: `learned_rows`."""
    out = dict(states)
    for entry in doc.entries:
        if entry.id in out and entry.id in learned_rows:
            names = learned_states(entry.element, learned_rows[entry.id][0])
            pairs = zip(out[entry.id], learned_rows[entry.id], strict=True)
            visible, coming = ({**old, **{name: new[name] for name in names}} for old, new in pairs)
            out[entry.id] = visible, coming
    return out


def put_learned(run: Run, learned_rows: Mapping[str, tuple[StateRow, StateRow]]) -> None:
    """Write what elements have learned, in rows of the present program, into the state of a run."""
    state = host(run.state)
    put_rows(
        run.program,
        state,
        with_learned(run.doc, learned_rows, rows(run.program, state)),
        nodes_of(run.program),
    )
    run.state = state


def beginning(run: Run, snapshot: SessionSnapshot) -> Document:
    """Return the document of a run with the values that were learned at a snapshot as initial values, over
    the present axes.

    Raises:
        ParameterError: they cannot be carried to the present axes.
    """
    fresh, _ = run.program.init(run.values, run.seed, run.trials)
    state = host(fresh)
    reasons = put_rows(run.program, state, snapshot.states, nodes(snapshot.document))
    by, entries = rows(run.program, state), run.doc.by_id()
    values: dict[str, np.ndarray] = {}
    for ident, name in (place.split(".", 1) for place in learned(snapshot)):
        # one that was stated after the values were kept stays
        before = snapshot.document.by_id()[ident].element
        if ident in entries and getattr(before, name, None) is not getattr(
            entries[ident].element, name, None
        ):
            continue
        if ident in reasons:
            raise ParameterError(
                f"what was learned cannot be carried: {reasons[ident]}",
                where=entries[ident].path,
                fix="Keep it again, or make another session",
            )
        if ident in entries:
            values[f"{entries[ident].path}.{name}"] = np.array(
                entries[ident].element.learned_parameters(by[ident][0])[name]
            )
    return edit.change_all(run.doc, values)


def keep(snapshot: SessionSnapshot, model: Model) -> list[str]:
    """Write learned values to a model as initial values; return the paths of the parameters.

    All values are one step of undo.

    Raises:
        ParameterError: the model no longer has one of the elements.
    """
    by = model.document.by_id()
    entries = snapshot.document.by_id()
    values: dict[str, np.ndarray] = {}
    for place, value in learned(snapshot).items():
        ident, name = place.split(".", 1)
        if ident not in by:
            raise ParameterError(
                "was learned, and is no longer in the model",
                where=entries[ident].path,
                fix="Undo its removal: model.undo()",
            )
        values[f"{by[ident].path}.{name}"] = value
    model.set(values)
    return list(values)
