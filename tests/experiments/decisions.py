"""Trials that a worker process can import: when does noise take a node over its threshold."""

from __future__ import annotations

from deodar.experiments.events import Crosses
from deodar.experiments.run import run_trial
from tests.experiments.robots import decider


def one(trial):
    """One row."""
    course = run_trial(decider(), 2000, trial=trial, events=[Crosses("decided", "u.activation")])
    return [{"key": f"d/{trial}", "outcome": course.outcome, "decided": course.events["decided"]}]
