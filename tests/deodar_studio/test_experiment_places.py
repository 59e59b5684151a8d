"""A page runs an experiment on a cluster, and follows one that another process runs."""

from __future__ import annotations

import contextlib
import shutil
import socket
import sys
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from distributed import LocalCluster

import deodar as dd
from deodar.batch import scheduler
from deodar.experiments import following, row_line, setup
from deodar.experiments.results import stored
from deodar.recording import writer_lock
from deodar_studio.experiment import experiment_run, run_place
from deodar_studio.web.service import Service
from tests.deodar_studio.page import Page, play, studio
from tests.deodar_studio.test_experiment import ended, experiment, few, rows


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with an experiment of 12 trials in pieces of two."""
    monkeypatch.setattr(setup, "MOST_COPIES", 2)
    monkeypatch.setattr(experiment_run, "STANDING_SECONDS", 0.0)
    root = tmp_path / "root"
    root.mkdir()
    few().save(root / "two-targets.json")
    return root


def listening() -> contextlib.AbstractContextManager[socket.socket]:
    """Bind a port at which nothing answers."""
    found = socket.socket()
    found.bind(("127.0.0.1", 0))
    return found


def at_its_experiment(
    folder: Path, scene: Callable[[Page], Awaitable[None]], token: bool = True, path: str = "two-targets.json"
) -> None:
    """Open a studio with the experiment, and play a scene in it."""

    async def whole(p: Page) -> None:
        await p.open("open_experiment", path=path)
        await scene(p)

    with studio(folder, token=token) as address:
        play(address, whole)


async def problem(p: Page, **message: Any) -> str:
    """Return what and how to correct it, of a run that is refused."""
    answer = await p.ask("run_experiment", **message)
    return " ".join(f"{q['where']} {q['what']}. {q['fix']}" for q in answer["problems"])


def test_the_processes_of_a_cluster_run_the_trials_and_are_counted(folder: Path) -> None:
    async def scene(p: Page) -> None:
        await p.do("run_experiment", cluster="local:2", patience=30)
        await ended(p)
        views = [m["run"] for m in p.all if m["type"] == "experiment" and m["run"] is not None]
        assert {view["cluster"] for view in views} == {"local:2"}
        assert max(view["workers"] for view in views) == 2
        assert max(view["pieces"] for view in views) == 4, "one runs and one waits, for each worker"
        assert any(view["slowest"].startswith("distance ") for view in views if view["state"] == "running")
        last = views[-1]
        assert (last["state"], last["rows"], last["workers"], last["slowest"]) == ("complete", 12, 0, "")
        await p.do("repeat_trial", trial=5)

    at_its_experiment(folder, scene)
    expected = few().run(folder / "by script", on=dd.Resources(workers=1))
    table = dd.load_results(folder / "two_targets-001")
    for name in ("place", "duration"):
        assert np.array_equal(table[name], expected[name], equal_nan=True)


def test_a_row_that_names_its_machine_is_repeated(folder: Path) -> None:
    async def scene(p: Page) -> None:
        await p.do("run_experiment", cluster="local:1", mixed=True)
        await ended(p)
        assert all(row["machine"] for row in rows(p))
        await p.do("repeat_trial", trial=5)
        assert experiment(p)["repeated"] == 5

    at_its_experiment(folder, scene)


def test_a_page_states_the_number_of_processes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_place, "MOST_WORKERS", 3)

    async def scene(p: Page) -> None:
        assert "4 processes are too many for this machine. Use at most 3" in await problem(p, workers=4)
        assert "4 processes are too many" in await problem(p, cluster="local:4")
        await p.do("run_experiment", workers=2)
        await ended(p)
        views = [m["run"] for m in p.all if m["type"] == "experiment" and m["run"] is not None]
        assert max(view["workers"] for view in views) == 2
        assert max(view["pieces"] for view in views) == 2 and {view["cluster"] for view in views} == {""}

    at_its_experiment(folder, scene)


def test_what_a_cluster_needs_is_said_before_anything_runs(folder: Path) -> None:
    async def scene(p: Page) -> None:
        assert p.said["welcome"]["clusters"] is True
        assert "is not the address of a cluster. Write local:N" in await problem(p, cluster="machine")
        assert "beyond this machine, without encryption" in await problem(p, cluster="tcp://10.0.0.5:8786")
        trusted = {"trust_network": True}
        assert "lies outside" in await problem(p, cluster="slurm:../jobs.yaml", **trusted)
        assert experiment(p)["run"] is None
        await p.do("run_experiment", cluster="slurm:jobs.yaml", **trusted)
        await ended(p)
        run = experiment(p)["run"]
        assert (run["state"], run["cluster"], run["rows"]) == ("failed", "slurm:jobs.yaml", 0)
        assert "jobs.yaml" in run["problems"][0]["where"] and "cannot be read" in run["problems"][0]["what"]

    at_its_experiment(folder, scene)


def test_only_a_private_studio_connects_where_a_page_says(folder: Path) -> None:
    """A scheduler can run programs in the process that connects to it."""
    assert Service(folder).private
    assert not Service(folder, token=False).private and not Service(folder, host="0.0.0.0").private

    async def scene(p: Page) -> None:
        assert p.said["welcome"]["clusters"] is False
        for address in ("tcp://127.0.0.1:8786", "tls://10.0.0.5:8786", "slurm:jobs.yaml", " tcp://[::1]:1"):
            said = await problem(p, cluster=address, trust_network=True)
            assert "a scheduler may run programs in it. Use local:N" in said
        assert experiment(p)["run"] is None
        await p.do("run_experiment", cluster="local:1")
        await ended(p)
        assert experiment(p)["run"]["state"] == "complete"

    at_its_experiment(folder, scene, token=False)


def test_the_search_for_a_scheduler_blocks_nothing_and_is_stopped(folder: Path) -> None:
    with listening() as taken:
        address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"

        async def scene(p: Page) -> None:
            await p.do("run_experiment", cluster=address)
            begun = time.monotonic()
            for _ in range(5):
                await p.do("list_folder")
            assert experiment(p)["run"]["state"] == "running" and experiment(p)["run"]["workers"] == 0
            await p.do("stop_experiment")
            await ended(p)
            assert experiment(p)["run"]["state"] == "stopped"
            assert time.monotonic() - begun < scheduler.CONNECT_SECONDS

        at_its_experiment(folder, scene)


def test_a_cluster_without_scheduler_workers_or_library_is_an_error_with_its_fix(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "CONNECT_SECONDS", 0.3)

    async def fails(p: Page, what: str, fix: str, **where: Any) -> None:
        def said() -> str:
            return " ".join(
                f"{q['what']} {q['fix']}" for q in (experiment(p)["run"] or {"problems": []})["problems"]
            )

        await p.do("run_experiment", **where)
        await p.until(lambda: what in said())
        assert fix in said()
        assert experiment(p)["run"]["state"] == "failed"

    async def scene(p: Page) -> None:
        with listening() as taken:
            address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
            await fails(p, "no scheduler of Dask answers", "dask scheduler", cluster=address)
        empty: Any = LocalCluster(n_workers=0, host="127.0.0.1", dashboard_address="127.0.0.1:0")
        with empty as made:
            waiting = {"cluster": made.scheduler_address, "patience": 0.5}
            await fails(p, "has had no worker for 0.5 s", "Start workers", **waiting)
        with monkeypatch.context() as without:
            without.setitem(sys.modules, "distributed", None)
            await fails(p, "distributed", "pip install 'deodar[cluster]'", cluster="local:1")

    at_its_experiment(folder, scene)


# ------------------------------------------------------------------------------------------------- following


@pytest.fixture
def begun(folder: Path) -> tuple[Path, list[str]]:
    """Return the results of an experiment with its first two rows, and the lines of the others."""
    few().run(folder / "results", on=dd.Resources(workers=1))
    lines = (folder / "results" / "trials.jsonl").read_text(encoding="utf-8").splitlines(keepends=True)
    shutil.copytree(folder / "results", folder / "theirs")
    (folder / "theirs" / "trials.jsonl").write_text("".join(lines[:3]), encoding="utf-8")
    return folder / "theirs", lines[3:]


def add(file: Path, lines: list[str]) -> None:
    with (file / "trials.jsonl").open("a", encoding="utf-8") as rows:
        rows.writelines(lines)


def test_an_experiment_that_another_process_runs_is_followed_to_its_end(
    folder: Path, begun: tuple[Path, list[str]]
) -> None:
    theirs, lines = begun

    async def scene(p: Page) -> None:
        run = experiment(p)["run"]
        assert (run["state"], run["rows"], run["trials"], run["left"]) == ("followed", 2, 12, None)
        await p.until(lambda: len(rows(p)) == 2)
        add(theirs, lines[:4])
        await p.until(lambda: len(rows(p)) == 6)
        await p.until(lambda: experiment(p)["run"]["left"] is not None)
        run = experiment(p)["run"]
        assert run["state"] == "followed" and run["slowest"].startswith("distance ") and run["left"] > 0
        assert "another process runs the experiment" in await problem(p)
        answer = await p.ask("repeat_trial", trial=0)
        assert "another process runs it" in answer["problems"][0]["what"]
        answer = await p.ask("save_experiment")
        assert "another process runs it" in answer["problems"][0]["what"]
        assert not (theirs / "repeats").exists()
        add(theirs, lines[4:])
        await p.until(lambda: experiment(p)["run"]["state"] == "complete")
        await p.until(lambda: len(rows(p)) == 12)
        await p.do("repeat_trial", trial=5)

    with writer_lock.locked(theirs):
        at_its_experiment(folder, scene, path="theirs/experiment.json")
    assert sorted(map(str, stored(theirs)[1])) == sorted(map(str, stored(folder / "results")[1]))


def test_a_line_that_is_not_a_row_is_named_when_results_are_opened(
    folder: Path, begun: tuple[Path, list[str]]
) -> None:
    theirs, lines = begun
    row = row_line.read(lines[0].encode(), True)
    row["other"] = row.pop("outcome")
    add(theirs, [row_line.write(row, True).decode()])

    async def scene(p: Page) -> None:
        answer = await p.ask("open_experiment", path="theirs/experiment.json")
        [found] = answer["problems"]
        assert found["what"] == "line 4 is not a row of its experiment: outcome"
        assert found["fix"].startswith("Remove that line")

    at_its_experiment(folder, scene)


def test_a_run_whose_process_has_ended_is_continued(folder: Path, begun: tuple[Path, list[str]]) -> None:
    theirs, lines = begun
    lock = contextlib.ExitStack()
    lock.enter_context(writer_lock.locked(theirs))

    async def scene(p: Page) -> None:
        assert experiment(p)["run"]["state"] == "followed"
        add(theirs, lines[:2])
        await p.until(lambda: len(rows(p)) == 4)
        lock.close()
        await p.until(lambda: experiment(p)["run"]["state"] == "stopped")
        await p.do("run_experiment", workers=1)
        await ended(p)
        assert (experiment(p)["run"]["state"], experiment(p)["run"]["rows"]) == ("complete", 12)

    at_its_experiment(folder, scene, path="theirs/experiment.json")


def test_rows_that_grow_without_a_lock_are_followed_until_they_are_quiet(
    folder: Path, begun: tuple[Path, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a folder that another machine writes, on a file system without locks."""
    theirs, lines = begun
    monkeypatch.setattr(following, "QUIET_SECONDS", 1.5)

    async def scene(p: Page) -> None:
        assert experiment(p)["run"]["state"] == "stopped"
        add(theirs, lines[:2])
        await p.until(lambda: experiment(p)["run"]["state"] == "followed")
        await p.until(lambda: len(rows(p)) == 4)
        await p.until(lambda: experiment(p)["run"]["state"] == "stopped")
        shutil.rmtree(theirs)
        await p.do("list_folder")

    at_its_experiment(folder, scene, path="theirs/experiment.json")
