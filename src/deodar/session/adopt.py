"""Continue a run with another document."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.leaves import step_limits
from deodar.model.document import Document
from deodar.session.changes import changed_leaves
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
    changed = changed_leaves(run.doc, doc)
    by = doc.by_id()
    if changed is None or any(
        limit.path == path for (i, path), *_ in changed for limit in step_limits(by[i].element)
    ):
        require(run, doc, steps)  # other leaves have no effect on the limit of the step
    cost = run.cost(changed, doc)
    if changed is not None and cost != "recompile":
        run.change(doc, changed)
        return cost
    states = rows(run.program, host(run.state))
    run.load(doc)
    fill(run, states)
    return "recompile"


def require(run: Run, doc: Document, steps: Iterable[float]) -> None:
    """Raise an error for a document that a run cannot continue with, as `adopt` does."""
    for step in set(steps):
        require_step(doc, step)
    run.exchange.require(doc)
