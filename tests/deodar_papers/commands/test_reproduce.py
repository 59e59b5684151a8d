"""`deodar reproduce` with a paper of six short trials."""

from __future__ import annotations

import errno
import json
import os
import re
import sys
import types

import pytest
from matplotlib.figure import Figure

from deodar import cli
from deodar.analysis.claims import Claim
from deodar.experiments.jobs import Job
from deodar.model import output
from deodar.progress import lasting
from deodar_papers import papers
from deodar_papers._report import Report
from tests.deodar.experiments import decisions


@pytest.fixture
def toy(monkeypatch, tmp_path):
    """Replace all papers by a small one, in an empty working folder."""
    paper = types.SimpleNamespace(HELP="toy", least=6, ran=[])

    def one(trial):
        paper.ran.append(trial)
        if trial == getattr(paper, "stops", None):
            raise KeyboardInterrupt
        return decisions.one(trial)

    def jobs(quick):
        return [Job((f"d/{k}",), one, {"trial": k}) for k in range(3 if quick else 6)]

    def report(rows, quick):
        claims = [
            Claim(
                "trials", len(rows), f">= {paper.least}", len(rows) >= paper.least, n=len(rows), origin="ours"
            ),
            Claim("heard", None, "?", None, "reported", origin="printed", assumes="the start", inferred=True),
        ]
        return Report(claims, {"nothing": Figure((1, 1))}, {"table": "| a |\n"})

    paper.jobs, paper.report, paper.BY_CONDITION = jobs, report, ("runs",)
    paper.about = lambda quick: {"paper": "toy", "quick": quick, "runs": {"d": 6}}
    monkeypatch.setattr(papers, "PAPERS", {"toy": paper})
    monkeypatch.chdir(tmp_path)
    return paper


def add_condition(toy):
    """Add a condition whose only trial computes nothing."""
    jobs = toy.jobs
    toy.jobs = lambda quick: [*jobs(quick), Job(("e/0",), lambda trial: [{"key": "e/0"}], {"trial": 0})]
    toy.about = lambda quick: {"paper": "toy", "quick": quick, "runs": {"d": 6, "e": 1}}


def call(*args):
    return cli.main(["reproduce", "toy", *args, "--no-progress"])


def test_reproduce_runs_a_paper_and_prints_its_claims(toy, capsys, tmp_path):
    assert call() == 0
    out = capsys.readouterr().out
    assert "yes trials -> 6 (wanted >= 6, ours; n 6)" in out
    assert re.search(r"6 of 6 runs, 6 of them in \d+ s by this call. Of 1 required claims 1 hold", out)
    assert "?   heard -> nothing yet (wanted ?, printed; n 1; no evidence, it assumes the start)" in out
    assert {p.name for p in (tmp_path / "toy-001").iterdir()} == {
        "runs.jsonl",
        "results.json",
        "table.md",
        "nothing.png",
    }
    report = json.loads((tmp_path / "toy-001" / "results.json").read_text())
    assert (
        report["settings"] == {"paper": "toy", "quick": False, "runs": 6, "of": 6}
        and report["claims"][0]["holds"] is True
    )
    call()
    assert (tmp_path / "toy-002").is_dir()


def test_a_required_claim_that_is_false_is_status_1(toy, capsys):
    toy.least = 7
    assert call("--json") == 1
    assert json.loads(capsys.readouterr().out)["claims"][0]["holds"] is False


def test_after_a_stop_the_same_call_resumes_with_the_same_rows(toy, capsys, tmp_path):
    call("--out", "whole")
    toy.stops = 4
    assert call("--out", "part") == 1
    message = capsys.readouterr().err
    assert "4 runs are kept. Resume with: deodar reproduce toy --out part" in message
    assert not (tmp_path / "part" / "results.json").exists()
    toy.stops, toy.ran = None, []
    assert call("--out", "part") == 0 and toy.ran == [4, 5]
    for name in ("runs.jsonl", "results.json"):
        assert (tmp_path / "part" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_the_command_to_resume_repeats_all_arguments(toy, capsys):
    toy.stops = 1
    assert call("--quick", "--only", "d", "--out", "some") == 1
    assert capsys.readouterr().err.endswith("deodar reproduce toy --quick --out some --only d\n")


def test_a_progress_bar_shows_the_number_of_runs(toy, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert cli.main(["reproduce", "toy", "--out", "here"]) == 0
    message = capsys.readouterr().err
    assert "of 6 trials" in message


def test_a_quick_folder_is_not_resumed_by_the_whole_reproduction(toy, capsys):
    toy.least = 3
    assert call("--quick", "--out", "here") == 0
    assert call("--out", "here") == 1
    assert "holds runs of another experiment: quick differ" in capsys.readouterr().err


def test_a_folder_is_extended_when_the_paper_has_further_conditions(toy, tmp_path):
    assert call("--out", "here") == 0
    add_condition(toy)
    toy.ran = []
    assert call("--out", "here") == 0 and toy.ran == []
    assert json.loads((tmp_path / "here" / "results.json").read_text())["settings"]["runs"] == 7


def test_only_selects_conditions_by_prefix(toy, capsys):
    add_condition(toy)
    assert call("--only", "f") == 1
    assert "no condition begins with 'f'" in capsys.readouterr().err
    toy.least = 1
    assert call("--only", "e") == 0 and toy.ran == []


def test_a_folder_with_other_content_is_not_changed(toy, capsys, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("all of it")
    assert call("--out", "mine") == 1
    assert "is not the folder of a reproduction" in capsys.readouterr().err
    assert [p.name for p in (tmp_path / "mine").iterdir()] == ["thesis.txt"]


def test_an_unknown_paper_is_reported(capsys):
    assert cli.main(["reproduce", "spaa"]) == 1
    assert "there is no paper called 'spaa'. Did you mean 'spa'?" in capsys.readouterr().err


def test_durations_are_printed_in_words():
    assert [lasting(s) for s in (4.2, 100, 3000, 11000)] == ["4 s", "2 min", "50 min", "3 h 3 min"]


def test_a_report_on_a_full_disk_is_written_to_the_user_data_folder(toy, monkeypatch, capsys, tmp_path):
    full, data_folder = tmp_path / "toy-001", tmp_path / "data"
    sync = output.sync

    def refuse(path):
        if full in path.parents:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(path)

    monkeypatch.setattr(output, "sync", refuse)
    monkeypatch.setattr("platformdirs.user_data_path", lambda *_, **__: data_folder)
    assert call() == 1
    printed = capsys.readouterr()
    (second,) = (data_folder / "results").iterdir()
    assert {p.name for p in second.iterdir()} == {"runs.jsonl", "results.json", "table.md", "nothing.png"}
    assert (second / "runs.jsonl").read_bytes() == (full / "runs.jsonl").read_bytes()
    assert str(second.relative_to(tmp_path)) in printed.out
    assert "No space left on device" in printed.err and "deodar reproduce toy --out toy-001" in printed.err
    monkeypatch.setattr(output, "sync", sync)
    toy.ran = []
    assert call("--out", "toy-001") == 0 and toy.ran == [] and (full / "results.json").is_file()


def test_a_full_disk_ends_the_reproduction_and_earlier_runs_are_kept(toy, monkeypatch, capsys):
    sync, room = os.fsync, [None] * 5  # the first line and its folder, and three runs

    def full(file):
        if not room:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        room.pop()
        sync(file)

    monkeypatch.setattr("deodar.model.output.os.fsync", full)
    assert call("--out", "part") == 1
    message = capsys.readouterr().err
    assert (
        "No space left on device" in message
        and "3 runs are kept" in message
        and "Resume with: deodar reproduce toy --out part" in message
    )
    room.extend([None] * 99)
    toy.ran = []
    assert call("--out", "part") == 0 and toy.ran == [3, 4, 5]
