"""The plan of an experiment: pieces, memory and time, and the number of workers that still helps."""

from __future__ import annotations

import time

from deodar.experiments import planning
from deodar.experiments.planning import WorkPlan, plan
from tests.deodar.experiments import clustered
from tests.deodar.experiments.calls import changed


def test_time_shrinks_until_every_piece_has_a_worker(monkeypatch):
    monkeypatch.setattr(planning, "START_SECONDS", 5.0)
    planned = WorkPlan((10, 10, 10, 4), 2.0, 0)
    assert [planned.duration(n) for n in (1, 2, 3, 4, 9)] == [73.0, 45.0, 33.0, 25.0, 25.0]
    assert planned.most == 4 and planned.counts() == [1, 2, 4]
    assert WorkPlan((3,), 1.0, 0).counts() == [1]
    assert WorkPlan((1,) * 6, 1.0, 0).counts() == [1, 2, 4, 6]


def test_short_pieces_keep_the_caller_busy(monkeypatch):
    monkeypatch.setattr(planning, "TASK_SECONDS", 0.01)
    planned = WorkPlan((5,) * 1000, 0.02, 0, row=300, record=700)
    assert planned.most == 10, "ten workers end a piece of 0.1 s every 0.01 s"
    assert planned.duration(10) == planned.duration(20) == planning.START_SECONDS + 10.0
    assert planned.stored == 5_000_000


def test_a_million_trials_for_thousands_of_workers_are_planned_at_once():
    planned = WorkPlan((20,) * 50_000, 3.0, 0)
    began = time.process_time()
    times = [planned.duration(n) for n in planned.counts()]
    assert planned.most == 12_000 and times == sorted(times, reverse=True)
    assert time.process_time() - began < 10.0, "about 0.3 s; with a search among all workers minutes"


def test_one_piece_is_measured(monkeypatch):
    clustered.small_pieces(monkeypatch)
    planned = plan(clustered.experiment(10, 300.0).setup(), 20)
    assert sum(planned.pieces) == 10 and max(planned.pieces) == 2
    assert 0 < planned.seconds < 10 and planned.memory > 50 * 2**20
    assert 100 < planned.row < 400 and planned.record == 0 and planned.stored == 10 * planned.row


def test_records_are_counted(monkeypatch):
    experiment = changed(clustered.experiment(4, 300.0), watch=["u.activation"], every=10)
    assert plan(experiment.setup(), 20).record == 31 * 4
