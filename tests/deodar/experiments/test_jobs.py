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


def ran(folder, text):
    (folder / "script.py").write_text(text)
    return subprocess.run(
        [sys.executable, "script.py"], cwd=folder, capture_output=True, text=True, timeout=600, check=False
    )


def test_an_experiment_in_a_script_runs_once_with_workers_and_needs_no_guard(tmp_path):
    script = ran(
        tmp_path,
        "import deodar as dd\nprint('begins')\nmodel = dd.Model('n')\n"
        "model.add(dd.Field('f', [], noise=1.0))\n"
        "plan = dd.Experiment('e', model, dd.TrialPlan(20), trials=4)\n"
        "print(plan.run(on=dd.Resources(workers=2)).sizes['trial'])\n",
    )
    assert script.stdout.split() == ["begins", "4"], script.stderr


def test_a_script_that_defines_what_jobs_use_and_has_no_guard_is_told_so(tmp_path):
    script = ran(
        tmp_path,
        "from pathlib import Path\nfrom deodar.experiments.jobs import Job, run_jobs\nfrom"
        " deodar.experiments.rows import Rows\nfrom deodar.resources import Resources\n"
        "def one(key):\n    return [{'key': key}]\n"
        "run_jobs([Job(('a',), one, {'key': 'a'})], Rows(Path('rows'), {}), Resources(workers=1))\n",
    )
    assert script.returncode and "below if __name__ == " in script.stderr.splitlines()[-1]
    assert "lack of memory" not in script.stderr
