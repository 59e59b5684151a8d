"""Continue a run with another document."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.model.document import Document
from deodar.session.run import Run, host, require_step
from deodar.session.session_snapshot import fill, rows


def adopt(run: Run, doc: Document, steps: Iterable[float]) -> str:
    """Continue with another document; elements that remain (by id) keep their states.

    Return the cost: live, rebuild or recompile. After an error nothing changed.

    Args:
        run: the run of one copy.
        doc: the document.
        steps: the Euler steps that it is to allow.

    Raises:
        TimeError: a step is too long for a time constant.
        WorldError: the world does not have a sensor or motor of the document.
    """
    new = run.continued(doc)
    if new is None or new.limiting:
        require(run, doc, steps)
    if new is not None:
        run.change(new)
        return new.cost
    states = rows(run.program, host(run.state))
    run.load(doc)
    fill(run, states)
    return "recompile"


def require(run: Run, doc: Document, steps: Iterable[float]) -> None:
    """Raise an error for a document that a run cannot continue with, as `adopt` does."""
    for step in set(steps):
        require_step(doc, step)
    run.exchange.require(doc)
