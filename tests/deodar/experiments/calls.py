"""Trials of a plan in one call, together or one alone beside its world."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import deodar as dd
from deodar.experiments.trial import Trial

PLAN = ("watch", "events", "measures", "actions", "every", "dt")
CALL = ("seed", "values", "between", "watched")


def run_alone(
    model: dd.Model,
    limit: float,
    world: dd.World | None = None,
    trial: int = 0,
    tolerant: bool = False,
    **options: Any,
) -> Trial:
    """Run one trial, beside its world on the host; `tolerant`: also if it diverges."""
    return _run(model, limit, False, tolerant, [trial], options | {"world": world})[0]


def run_together(
    model: dd.Model,
    limit: float,
    numbers: Sequence[int],
    watch: Sequence[str] = (),
    events: Sequence[dd.Event] = (),
    tolerant: bool = False,
    **options: Any,
) -> list[Trial]:
    """Run trials in one batch; `tolerant`: also if all diverge."""
    return _run(model, limit, True, tolerant, numbers, options | {"watch": watch, "events": events})


def changed(experiment: dd.Experiment, **others: Any) -> dd.Experiment:
    """Return an experiment with other parameters, its own and those of its plan."""
    of_plan = {name: others.pop(name) for name in ("limit", *PLAN) if name in others}
    return dc.replace(experiment, plan=dc.replace(experiment.plan, **of_plan), **others)


def _run(
    model: dd.Model,
    limit: float,
    together: bool,
    tolerant: bool,
    numbers: Sequence[int],
    options: dict[str, Any],
) -> list[Trial]:
    plan = dd.TrialPlan(limit, **{name: options[name] for name in PLAN if name in options})
    settings = {name: value for name, value in options.items() if name not in (*PLAN, *CALL)}
    trials = dd.Trials(model, plan, **settings, together=together)
    call = {name: options[name] for name in CALL if name in options}
    return (trials.results if tolerant else trials.run)(numbers, **call)
