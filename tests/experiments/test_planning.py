"""The plan of an experiment: pieces, memory and time, and the number of workers that still helps."""

from __future__ import annotations

from deodar.experiments import planning
from deodar.experiments.planning import WorkPlan, plan
from tests.experiments import clustered


def test_time_shrinks_until_every_piece_has_a_worker(monkeypatch):
    monkeypatch.setattr(planning, "START_SECONDS", 5.0)
    found = WorkPlan((10, 10, 10, 4), 2.0, 0)
    assert [found.duration(n) for n in (1, 2, 3, 4, 9)] == [73.0, 45.0, 33.0, 25.0, 25.0]
    assert found.most == 4 and found.counts() == [1, 2, 4]
    assert WorkPlan((3,), 1.0, 0).counts() == [1]
    assert WorkPlan((1,) * 6, 1.0, 0).counts() == [1, 2, 4, 6]


def test_one_piece_is_measured(monkeypatch):
    clustered.small_pieces(monkeypatch)
    found = plan(clustered.experiment(10, 300.0).setup(), 20)
    assert sum(found.pieces) == 10 and max(found.pieces) == 2
    assert 0 < found.seconds < 10 and found.memory > 50 * 2**20
    assert found.duration(2) < found.duration(1)
