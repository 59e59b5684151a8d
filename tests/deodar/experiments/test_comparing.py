"""Trials that are run on two kinds of machines: which, and what is said where outcomes differ."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from deodar.errors import RunWarning
from deodar.experiments import comparing
from deodar.experiments.jobs import MACHINE, Job
from deodar.experiments.rows import KEY, Row, Rows


def work(trials: list[int], records: Path | None) -> list[Row]:
    assert records is None, "the records of the rows stay"
    return [{KEY: f"{k:06}", "trial": k, "outcome": "left" if k < 51 else "right"} for k in trials]


class TwoKinds:
    """A pool that runs tasks at once, on the machine that is asked for."""

    def __init__(self, machines: list[str]) -> None:
        self.machines, self.done = machines, list[Any]()

    @property
    def idle(self) -> int:
        return 2 - len(self.done)

    @property
    def busy(self) -> int:
        return len(self.done)

    def give(self, key: Any, function: Any, job: Job, machine: str) -> None:
        self.done.append((key, [{**row, MACHINE: machine} for row in function(job)]))

    def look(self) -> None:
        self.looks = getattr(self, "looks", 0) + 1

    def wait(self, seconds: float) -> list[Any]:
        out, self.done = self.done, []
        return out


def stored(folder: Path) -> tuple[list[Job], Rows]:
    """Return 100 pieces of one trial, and their rows, all from machine A."""
    jobs = [Job((f"{k:06}",), work, {"trials": [k], "records": folder}) for k in range(100)]
    rows = Rows(folder / "trials.jsonl", {})
    rows.append([{KEY: f"{k:06}", "trial": k, "outcome": "left", MACHINE: "A"} for k in range(100)])
    return jobs, rows


def test_two_per_cent_of_the_pieces_are_compared_and_other_outcomes_are_reported(tmp_path: Path) -> None:
    jobs, rows = stored(tmp_path)
    before = (tmp_path / "trials.jsonl").read_bytes()
    pool: Any = TwoKinds(["A", "B"])
    comparing.compare(jobs, rows, pool, tmp_path)
    assert pool.looks, "the comparison can be stopped"
    table = (tmp_path / "machines.csv").read_text().splitlines()
    assert table[1:] == ["0,A,left,B,left,True", "50,A,left,B,left,True"]
    (tmp_path / "machines.csv").unlink()
    with pytest.warns(RunWarning, match="1 of 3 compared trials have another outcome"):
        comparing.compare([*jobs, *jobs[60:90]], rows, pool, tmp_path)
    assert "86,A,left,B,right,False" in (tmp_path / "machines.csv").read_text()
    assert (tmp_path / "trials.jsonl").read_bytes() == before


def test_workers_of_one_kind_and_an_existing_table_compare_nothing(tmp_path: Path) -> None:
    jobs, rows = stored(tmp_path)
    alone: Any = TwoKinds(["A"])
    comparing.compare(jobs, rows, alone, tmp_path)
    assert not (tmp_path / "machines.csv").exists()
    (tmp_path / "machines.csv").write_text("as before")
    both: Any = TwoKinds(["A", "B"])
    comparing.compare(jobs, rows, both, tmp_path)
    assert (tmp_path / "machines.csv").read_text() == "as before"
