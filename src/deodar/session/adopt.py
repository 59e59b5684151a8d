"""Continue a run with another document."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.model.document import Document
from deodar.session.carry import fill, nodes_of, require_carried
from deodar.session.run import Run, host, require_step
from deodar.session.session_snapshot import rows


def adopt(run: Run, doc: Document, steps: Iterable[float]) -> str:
    """Continue with another document; elements that remain (by id) keep their states, over their new axes.

    Return the cost: live, rebuild or recompile. After an error nothing changed.

    Args:
        run: the run of one copy.
        doc: the document.
        steps: the Euler steps that it is to allow.

    Raises:
        TimeError: a step is too long for a time constant.
        WorldError: the world does not have a sensor or motor of the document.
        ParameterError: a state cannot be carried.
    """
    new = run.continued(doc)
    if new is not None:
        if new.limiting:
            _require_steps(run, doc, steps)
        run.change(new)
        return new.cost
    require(run, doc, steps)
    states, before = rows(run.program, host(run.state)), nodes_of(run.program)
    with run.undone_on_error():
        run.load(doc)
        fill(run, states, before)
    return "recompile"


def require(run: Run, doc: Document, steps: Iterable[float]) -> None:
    """Raise an error for a document that a run cannot continue with, as `adopt` does."""
    _require_steps(run, doc, steps)
    require_carried(run, doc)


def _require_steps(run: Run, doc: Document, steps: Iterable[float]) -> None:
    for step in set(steps):
        require_step(doc, step)
    run.exchange.require(doc)
