"""Jobs: missing rows are computed, in any pieces and processes, with the same result."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from deodar.experiments.jobs import Job, run_jobs
from deodar.experiments.rows import Rows
from deodar.resources import Resources
from tests.deodar.experiments import decisions

ROOT = Path(__file__).resolve().parents[3]


def jobs(n=6):
    return [Job((f"d/{k}",), decisions.one, {"trial": k}, cost=1.0 + k) for k in range(n)]


@pytest.fixture(scope="module")
def rows():
    """Return the rows of all jobs, run in this process."""
    return [row for job in jobs() for row in job.run()]


def test_all_jobs_are_run_and_progress_reaches_the_end(tmp_path, rows):
    seen = []
    kept = Rows(tmp_path / "runs.jsonl", {})
    run_jobs(jobs(), kept, Resources(progress=seen.append))
    assert list(kept.found.values()) == rows
    assert [*map(int, seen)] == list(range(7)) and {s.of for s in seen} == {6}
    assert seen[0].seconds_left is None and seen[-1].seconds_left == 0 and seen[-1].share == 1
    assert seen[3].share == pytest.approx(6 / 21)


def test_only_missing_jobs_are_run(tmp_path, rows):
    kept = Rows(tmp_path / "runs.jsonl", {})
    kept.append([row | {"outcome": "kept"} for row in rows[:2]])
    seen = []
    run_jobs(jobs(), kept, Resources(progress=seen.append))
    assert [*map(int, seen)] == [2, 3, 4, 5, 6] and seen[0].share == pytest.approx(3 / 21)
    assert [row["outcome"] for row in seen[0].new] == ["kept"] * 2
    assert [r["outcome"] for r in kept.found.values()][:2] == ["kept"] * 2
    assert list(kept.found.values())[2:] == rows[2:]


def test_workers_give_the_same_rows(tmp_path, rows):
    kept = Rows(tmp_path / "runs.jsonl", {})
    run_jobs(jobs(), kept, Resources(workers=2))
    assert sorted(kept.found.values(), key=lambda r: r["key"]) == rows


def test_a_killed_run_resumes_with_the_same_rows(tmp_path, rows):
    file = tmp_path / "runs.jsonl"
    code = (
        "from pathlib import Path; from deodar.experiments.jobs import run_jobs; from"
        " deodar.experiments.rows import Rows\nfrom tests.deodar.experiments.test_jobs import jobs;"
        f" run_jobs(jobs(), Rows(Path({str(file)!r}), {{}}))"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}
    )
    while process.poll() is None and not (file.exists() and file.read_bytes().count(b"\n") >= 3):
        time.sleep(0.002)
    process.kill()
    process.wait()
    assert file.read_bytes().count(b"\n") >= 3
    kept = Rows(file, {})
    run_jobs(jobs(), kept)
    assert list(kept.found.values()) == rows


def test_ctrl_c_keeps_the_rows_of_the_jobs_that_run(tmp_path, rows):
    kept, pressed = Rows(tmp_path / "runs.jsonl", {}), []

    def watch(standing):
        if standing and not pressed:
            pressed.append(standing)
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        run_jobs(jobs()[:3], kept, Resources(workers=2, progress=watch))
    assert len(kept.found) > pressed[0], "the other worker's job was ended, and its rows were kept"
    run_jobs(jobs(), kept)
    assert sorted(kept.found.values(), key=lambda r: r["key"]) == rows
