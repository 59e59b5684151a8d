"""Parts of an experiment: together they are the whole, and only parts of one experiment are merged."""

from __future__ import annotations

import math

import pytest

from deodar.errors import OutputExists, ParameterError, RecordError
from deodar.experiments import row_line
from deodar.experiments.following import standing
from deodar.experiments.merging import gaps, merge_results
from deodar.experiments.results import load_results
from tests.deodar.experiments import clustered


@pytest.fixture
def parts(tmp_path, monkeypatch):
    """Run the experiment whole, and in two parts; return the folders."""
    clustered.small_pieces(monkeypatch)
    experiment = clustered.experiment(8, 400.0)
    for name, part in (("whole", None), ("first", (0, 3)), ("second", (3, 8))):
        experiment.run(tmp_path / name, part=part)
    return tmp_path


def test_parts_are_merged_to_the_same_rows(parts):
    assert load_results(parts / "first").trial.values.tolist() == [0, 1, 2, 3], "the pieces 0:2 and 2:4"
    merged = merge_results([parts / "second", parts / "first"], parts / "merged")
    assert not merged.gaps
    assert clustered.lines(parts / "merged") == clustered.lines(parts / "whole")
    for name in ("trials.csv", "experiment.json", "model.json"):
        assert (parts / "merged" / name).read_bytes() == (parts / "whole" / name).read_bytes()
    clustered.experiment(8, 400.0).run(parts / "merged")
    with pytest.raises(OutputExists, match="exists"):
        merge_results([parts / "first"], parts / "merged")


def test_missing_trials_are_listed(parts):
    assert merge_results([parts / "first"], parts / "merged").gaps == ((4, 8),)
    assert gaps({1, 2, 5}, 7) == ((0, 1), (3, 5), (6, 7))


def test_other_experiments_and_other_rows_are_refused(parts):
    clustered.experiment(8, 500.0).run(parts / "other")
    with pytest.raises(RecordError, match=r"other: holds another experiment than .*: limit differ"):
        merge_results([parts / "first", parts / "other"], parts / "merged")
    file = parts / "first" / "trials.jsonl"
    lines = file.read_bytes().splitlines(keepends=True)
    lines[1] = row_line.write(row_line.read(lines[1], True) | {"duration": 1.0}, True)
    file.write_bytes(b"".join(lines))
    with pytest.raises(RecordError, match="has another row of trial 0 than"):
        merge_results([parts / "whole", parts / "first"], parts / "merged")
    with pytest.raises(RecordError, match="no folder is named"):
        merge_results([], parts / "merged")
    assert not (parts / "merged").exists()


@pytest.mark.parametrize("part", [(0, 0), (3, 9), (-1, 2)])
def test_a_part_outside_of_the_trials_is_refused(tmp_path, part):
    with pytest.raises(ParameterError, match="are no part of 0 to 8"):
        clustered.experiment(8).run(tmp_path / "out", part=part)


def test_the_standing_names_slow_and_failing_cells():
    rows = [
        {"key": "0", "trial": 0, "levels": {"a": 1}, "outcome": "time", "duration": 30.0},
        {"key": "1", "trial": 1, "levels": {"a": 1}, "outcome": "seen", "duration": 10.0},
        {"key": "2", "trial": 2, "levels": {"a": 2}, "outcome": "seen", "duration": 50.0},
        {
            "key": "3",
            "trial": 3,
            "levels": {"a": 3},
            "outcome": "diverged",
            "duration": None,
            "diverged": "u",
        },
    ]
    rows[3]["diverged"] = "u became infinite"
    progress = standing(rows, 8, (100.0, 2), 110.0)
    assert (progress.rows, progress.of, progress.share, progress.left) == (4, 8, 0.5, 20.0)
    assert [cell.levels for cell in progress.cells] == [{"a": 2}, {"a": 1}, {"a": 3}]
    assert (progress.cells[1].duration, progress.cells[1].cut, progress.cells[1].failed) == (20.0, 1, 0)
    assert math.isnan(progress.cells[2].duration) and [cell.levels for cell in progress.failing] == [{"a": 3}]
    assert standing([], 0).share == 1.0 and standing([], 3).left is None
