"""An experiment in many small pieces, its workers on this machine, and a limit of time for what must end."""

from __future__ import annotations

import threading

import psutil

from deodar.batch import scheduler
from deodar.elements.field import Field
from deodar.experiments import setup
from deodar.experiments.events import Crosses
from deodar.experiments.experiment import Experiment
from deodar.experiments.factor import Factor
from deodar.experiments.trial import TrialPlan
from deodar.model.model import Model

LIMIT = 60.0
"""Wall time after which a call counts as one that never ends, in seconds."""


def slurm_script(file):
    """Return the script of a job that `slurm:FILE` submits."""
    cluster_of_jobs, _ = scheduler._slurm(file)
    try:
        return cluster_of_jobs.job_script()
    finally:
        scheduler._closed(cluster_of_jobs)


def experiment(trials=24, limit=1500.0):
    """Return an experiment of `trials` trials in pieces of two: noise drives a node over its threshold."""
    model = Model("decision")
    model.add(Field("u", [], tau=20, resting_level=-1, noise=3.0))
    factors = [Factor("level", [-1.0, -2.0], "u.resting_level")]
    return Experiment(
        "decisions",
        model,
        TrialPlan(limit, events=[Crosses("decided", "u.activation")]),
        trials // 2,
        factors=factors,
    )


def small_pieces(monkeypatch):
    """Cut the trials into pieces of two."""
    monkeypatch.setattr(setup, "MOST_COPIES", 2)


def processes(of=None):
    """Return the worker processes that Dask started below a process; none: this one."""
    processes = (psutil.Process() if of is None else psutil.Process(of)).children(recursive=True)
    out = []
    for process in processes:
        try:
            if (
                any("spawn_main" in part for part in process.cmdline())
                and process.status() != psutil.STATUS_ZOMBIE
            ):
                out.append(process)
        except psutil.NoSuchProcess:
            continue
    return out


def within(function, seconds=LIMIT):
    """Return what a function returns or raises, in a thread; fail if it does not end in time."""
    out = []

    def call():
        try:
            out.append((True, function()))
        except BaseException as error:
            out.append((False, error))

    thread = threading.Thread(target=call, daemon=True)
    thread.start()
    thread.join(seconds)
    assert out, f"the call has not ended after {seconds} s"
    good, answer = out[0]
    if not good:
        raise answer
    return answer


def lines(folder):
    """Return the lines of the file of rows, in the order of their keys."""
    return sorted((folder / "trials.jsonl").read_text(encoding="utf-8").splitlines())
