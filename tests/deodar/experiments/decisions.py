"""Trials that a worker process can import: the time at which noise drives a node over its threshold."""

from __future__ import annotations

from deodar.experiments.events import Crosses
from tests.deodar.experiments.calls import run_alone
from tests.deodar.experiments.robots import decider


def one(trial):
    """Return one row."""
    course = run_alone(decider(), 2000, trial=trial, events=[Crosses("decided", "u.activation")])
    return [{"key": f"d/{trial}", "outcome": course.outcome, "decided": course.events["decided"]}]
