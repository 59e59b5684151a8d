"""`deodar experiment`: it writes the table, resumes a stopped run, and reports errors before a run."""

from __future__ import annotations

import errno
import io
import json
import re
import sys
import threading
import time

import pytest

from deodar import cli
from deodar.batch import scheduler, simulate
from deodar.cli import _long
from deodar.experiments import following, planning, setup
from deodar.experiments.events import Crosses
from deodar.experiments.experiment import Experiment
from deodar.experiments.factor import Factor
from deodar.experiments.results import load_results
from deodar.experiments.trial import TrialPlan
from tests.deodar.experiments.robots import decider


@pytest.fixture
def file(tmp_path, monkeypatch):
    """Write an experiment with a node that noise drives over its threshold into the working folder."""
    monkeypatch.chdir(tmp_path)
    conditions = [
        Crosses("decided", "u.activation"),
        Crosses("low", "u.activation", -3.0, "below", ends=False),
    ]
    Experiment(
        "when",
        decider(),
        TrialPlan(400, events=conditions),
        8,
        factors=[Factor("noise", [2.0, 4.0], "u.noise")],
    ).save("when.json")
    return tmp_path / "when.json"


def call(*args):
    """Return the status of a call without a progress bar."""
    return cli.main(["experiment", "when.json", "--no-progress", *args])


def test_an_experiment_writes_a_table_a_dataset_and_its_design(file, capsys, tmp_path):
    assert call() == 0
    out = capsys.readouterr().out
    assert (
        "noise 2: 8 trials" in out
        and "16 trials: decided" in out
        and "Written to when-001: experiment.json" in out
    )
    assert {p.name for p in (tmp_path / "when-001").iterdir()} == {
        "experiment.json",
        "model.json",
        "trials.csv",
        "trials.jsonl",
        "trials.nc",
    }
    lines = (tmp_path / "when-001" / "trials.csv").read_text().splitlines()
    assert lines[0] == "trial,noise,outcome,awaited,duration,decided,low" and len(lines) == 17
    assert call("--out", "when-001") == 0  # nothing is left to be run
    status = cli.main(["experiment", "when-001/experiment.json", "--out", "again", "--no-progress"])
    assert status == 0 and load_results(tmp_path / "again").identical(load_results(tmp_path / "when-001"))


def test_the_model_may_be_an_example(file, capsys, tmp_path):
    document = json.loads((tmp_path / "when.json").read_text())
    document |= {
        "model": "example:node",
        "limit": 20,
        "factors": {},
        "conditions": {"decided": {"kind": "Crosses", "of": "u.activation"}},
    }
    (tmp_path / "when.json").write_text(json.dumps(document))
    assert call("--trials", "2", "--json") == 0
    assert json.loads(capsys.readouterr().out)["trials"] == 2
    document["model"] = "example:nod"
    (tmp_path / "when.json").write_text(json.dumps(document))
    assert call() != 0
    assert "node" in capsys.readouterr().err


def test_the_same_call_resumes_an_interrupted_experiment(file, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr("deodar.experiments.setup.MOST_COPIES", 4)
    assert call("--out", "whole") == 0
    from deodar.experiments import jobs

    real, count = jobs.Job.run, []

    def stops(job):
        count.append(job)
        if len(count) > 2:
            raise KeyboardInterrupt
        return real(job)

    monkeypatch.setattr(jobs.Job, "run", stops)
    assert call("--out", "part", "--seed", "0") == 130
    assert capsys.readouterr().err.endswith("Resume with: deodar experiment when.json --out part --seed 0\n")
    assert load_results(tmp_path / "part").sizes["trial"] == 8
    monkeypatch.setattr(jobs.Job, "run", real)
    assert call("--out", "part") == 0
    assert (tmp_path / "part" / "trials.csv").read_bytes() == (tmp_path / "whole" / "trials.csv").read_bytes()


def test_options_replace_trials_and_seed_and_json_reports_the_outcomes(file, capsys, tmp_path):
    assert call("--trials", "2", "--seed", "5", "--json", "--out", "few") == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["trials"] == 4 and sum(answer["outcomes"].values()) == 4 and answer["out"] == "few"
    assert json.loads((tmp_path / "few" / "experiment.json").read_text())["seed"] == 5
    assert call("--out", "few") == 1
    assert "holds runs of another experiment: seed, trials differ" in capsys.readouterr().err


def test_check_runs_no_trial(file, capsys, tmp_path):
    assert call("--check") == 0
    assert "when: 16 trials, in 1 batch of at most 16" in capsys.readouterr().out
    assert call("--check", "--json") == 0
    assert json.loads(capsys.readouterr().out) == {"trials": 16, "batched": True, "pieces": [16]}
    assert {p.name for p in tmp_path.iterdir()} == {"when.json", "when.model.json"}


def test_errors_are_reported_before_a_run(file, capsys, tmp_path):
    document = json.loads(file.read_text())
    document["conditions"]["decided"]["of"] = "v.activation"
    file.write_text(json.dumps(document))
    assert call("--out", "none") == 1
    assert (
        "conditions.decided: nothing is called 'v.activation'. Valid names: u, u.activation, "
        in capsys.readouterr().err
    )
    assert not (tmp_path / "none").exists()
    assert cli.main(["experiment", "wen.json"]) == 1
    assert "there is no such file. Did you mean 'when.json'?" in capsys.readouterr().err
    assert cli.main(["experiment", "when.model.json"]) == 1
    assert "is not an experiment" in capsys.readouterr().err


def test_a_model_given_as_an_experiment_and_the_reverse_name_the_right_command(file, capsys, tmp_path):
    assert cli.main(["check", str(file)]) == 1
    fix = "Type: deodar experiment FILE --check"
    assert capsys.readouterr().err == f"deodar check: {file}: is not a model: it is an experiment. {fix}\n"
    model = file.with_name(json.loads(file.read_text())["model"])
    assert cli.main(["experiment", str(model)]) == 1
    fix = "Type: deodar run FILE --duration MS"
    assert (
        capsys.readouterr().err == f"deodar experiment: {model}: is not an experiment: it is a model. {fix}\n"
    )


def test_very_many_steps_in_total_need_yes(file, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(simulate, "LONG_STEPS", 16 * 400)
    monkeypatch.setattr(_long, "TRIAL_SECONDS", 0.0)
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    assert call("--out", "out") == 1 and not (tmp_path / "out").exists()
    error = capsys.readouterr().err.replace("\n", " ")
    assert re.search(
        r"deodar experiment: 16 trials of at most 400 steps of dt = 1 take about \S+ \w+ on this machine",
        error,
    )
    assert "cannot ask for confirmation" in error and "--yes" in error
    assert call("--out", "out", "--yes") == 0
    assert "16 trials of at most 400 steps" in capsys.readouterr().err
    assert call("--out", "out") == 0, "nothing is left to be run"
    assert call("--out", "fewer", "--trials", "7") == 0
    assert "on this machine" not in capsys.readouterr().err


def test_a_full_disk_keeps_complete_trials_and_states_how_to_resume(file, capsys, tmp_path, monkeypatch):
    from deodar.model import output

    with monkeypatch.context() as patch:
        patch.setattr(
            output,
            "sync",
            lambda path: (
                (_ for _ in ()).throw(OSError(errno.ENOSPC, "No space left on device"))
                if path.suffix == ".csv"
                else None
            ),
        )
        assert call("--out", "out") == 1
    error = capsys.readouterr().err
    assert (
        "trials.csv: cannot be written: No space left on device" in error
        and "Resume with: deodar experiment when.json --out out" in error
    )
    assert (
        not (tmp_path / "out" / "trials.csv").exists() and load_results(tmp_path / "out").sizes["trial"] == 16
    )
    assert call("--out", "out") == 0 and (tmp_path / "out" / "trials.csv").is_file()


def test_options_of_a_cluster_need_one_and_exclude_workers(file, capsys):
    for arguments, says in (
        (["--trust-network"], "--trust-network needs --cluster ADDRESS"),
        (["--patience", "5"], "--patience needs --cluster ADDRESS"),
        (["--cluster", "local:2", "--workers", "2"], "--workers and --cluster exclude each other"),
    ):
        with pytest.raises(SystemExit) as end:
            call(*arguments)
        assert end.value.code == 2 and says in capsys.readouterr().err
    assert call("--cluster", "tcp://10.0.0.5:8786") == 1
    assert "--trust-network" in capsys.readouterr().err


def test_an_error_of_a_cluster_says_how_to_resume(file, capsys, monkeypatch):
    monkeypatch.setattr(scheduler, "CONNECT_SECONDS", 0.3)
    assert call("--out", "out") == 0
    assert call("--out", "out", "--cluster", "tcp://127.0.0.1:9", "--patience", "5") == 1
    error = capsys.readouterr().err
    assert "no scheduler of Dask answers at tcp://127.0.0.1:9" in error and "What is done is kept." in error
    assert "--out out --cluster tcp://127.0.0.1:9 --patience 5" in error


def test_parts_are_followed_and_merged(file, capsys, monkeypatch):
    monkeypatch.setattr(setup, "MOST_COPIES", 8)
    monkeypatch.setattr(following, "QUIET_SECONDS", 0.0)
    assert call("--trials", "0:8", "--out", "first") == 0
    assert call("--follow", "first") == 1
    printed = capsys.readouterr()
    assert "8 of 16 trials (50 %); slowest: noise 2, median" in printed.out
    assert "no process runs it" in printed.err
    assert call("--follow", "first", "--trials", "0:8") == 0
    assert cli.main(["experiment", "merge", "first", "--out", "half"]) == 1
    assert "Trials without a row, as --trials names them: 8:16" in capsys.readouterr().out
    assert call("--trials", "8:16", "--out", "second") == 0
    assert cli.main(["experiment", "merge", "first", "second", "--out", "whole"]) == 0
    assert load_results("whole").sizes["trial"] == 16
    for wrong, says in (
        (["merge", "first"], "merge needs folders"),
        (["when.json", "a"], "only merge takes"),
    ):
        with pytest.raises(SystemExit):
            cli.main(["experiment", *wrong])
        assert says in capsys.readouterr().err


def test_a_run_is_followed_until_it_ends(file, capsys, monkeypatch):
    monkeypatch.setattr(following, "FOLLOW_SECONDS", 0.02)
    monkeypatch.setattr(setup, "MOST_COPIES", 2)
    (file.parent / "out").mkdir()
    (file.parent / "out" / "trials.jsonl").touch()
    thread = threading.Thread(target=lambda: Experiment.load("when.json").run(file.parent / "out"))
    thread.start()
    while not (file.parent / "out" / "trials.jsonl").read_bytes():
        time.sleep(0.002)
    assert call("--follow", "out") == 0
    thread.join()
    assert "16 of 16 trials (100 %)" in capsys.readouterr().out


def test_rows_of_another_machine_are_followed_where_its_lock_is_not_seen(file, capsys, monkeypatch):
    monkeypatch.setattr(following, "FOLLOW_SECONDS", 0.02)
    monkeypatch.setattr(following, "QUIET_SECONDS", 0.5)
    assert call("--out", "whole") == 0
    rows = (file.parent / "whole" / "trials.jsonl").read_text(encoding="utf-8").splitlines(keepends=True)
    (file.parent / "far").mkdir()
    far = file.parent / "far" / "trials.jsonl"
    far.write_text("".join(rows[:3]), encoding="utf-8")

    def writes():
        for row in rows[3:10]:
            time.sleep(0.15)
            with far.open("a", encoding="utf-8") as appended:
                appended.write(row)

    thread = threading.Thread(target=writes)
    thread.start()
    assert call("--follow", "far") == 1
    thread.join()
    printed = capsys.readouterr()
    assert "9 of 16 trials" in printed.out
    first, last = printed.err.splitlines()
    assert first.endswith("no process of this machine runs it; rows of another one are awaited for 0.5 s")
    assert last.endswith("no process runs it; the call that began it resumes it")


def test_a_part_within_a_batch_says_who_runs_its_trials(file, capsys):
    assert call("--trials", "3:5", "--out", "part") == 0
    assert "0 trials: their batch begins before this part" in capsys.readouterr().out


def test_a_plan_prints_pieces_memory_and_time(file, capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(setup, "MOST_COPIES", 4)
    # a piece takes some milliseconds, on a quick machine fewer than the caller is said to need for it
    monkeypatch.setattr(planning, "TASK_SECONDS", 1e-9)
    assert call("--plan") == 0
    out = capsys.readouterr().out
    assert (
        "when: 16 trials in 4 pieces of at most 4; about" in out
        and "More than 4 workers would not help: each has one piece." in out
    )
    assert re.search(r"stored: \d+ bytes for a row of each trial, [0-9.]+ kB in total", out)
    assert "  1 worker: at most" in out and "  4 workers: at most" in out
    assert call("--plan", "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert list(answer["times"]) == ["1", "2", "4"] and answer["pieces"] == [4] * 4
    assert answer["stored"] == 16 * answer["row"]
    with pytest.raises(SystemExit):
        cli.main(["plan", "when.json", "--cluster", "--devices", "8"])
    assert "--devices is for a model, and --cluster plans an experiment" in capsys.readouterr().err
    assert cli.main(["plan", "when.json", "--cluster"]) == 0
    assert "when: 16 trials in 4 pieces of at most 4; about" in capsys.readouterr().out
    assert not list(tmp_path.glob("when-*"))
