"""A disk that fills at the end of a run: the result is kept, and written to a second place."""

from __future__ import annotations

import errno
import io
import json
import os
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.analysis.claims import Claim
from deodar.cli import main
from deodar.model import output
from deodar.recording import files
from deodar.recording.growing import GrowingRecord
from deodar_papers.papers import Demonstration
from deodar_papers.spa import demo
from tests.deodar.recording.models import model


class Terminal(io.StringIO):
    """A terminal with the lines that a user types."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make a working folder on a full disk, and a second place and a temporary folder on others."""
    folder = tmp_path / "full"
    for name in ("full", "second", "temporary", "data"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(folder)
    dd.save(model(), "small.json")
    sync = output.sync

    def refuse(path: Path) -> None:
        if folder in path.resolve().parents:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(path)

    monkeypatch.setattr(output, "sync", refuse)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    monkeypatch.setattr("platformdirs.user_data_path", lambda *_, **__: tmp_path / "data" / "deodar")
    monkeypatch.setenv("DEODAR_CACHE", "off")
    return folder


RUN = shlex.split("run small.json --duration 20 --every 5 --record u.activation --out result --no-progress")


def test_a_run_on_a_full_disk_ends_before_its_first_sample_and_leaves_nothing(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(RUN) == 1
    printed = capsys.readouterr()
    assert "No space left on device" in printed.err and not printed.out
    assert [p.name for p in workspace.iterdir()] == ["small.json"]


def test_a_disk_that_fills_during_a_run_keeps_its_record_which_is_resumed(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with monkeypatch.context() as filling:
        filling.setattr(output, "sync", lambda path: None)
        write, calls = GrowingRecord._write, []

        def refuse(self: GrowingRecord, *arguments: Any) -> None:
            calls.append(0)
            if len(calls) > 1:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            write(self, *arguments)

        filling.setattr(GrowingRecord, "_write", refuse)
        filling.setattr("deodar.session.run.CHUNK_SECONDS", 0.0)
        assert main([*RUN, "--snapshots", "5"]) == 1
    printed = capsys.readouterr().err
    assert "No space left on device" in printed and "is kept" in printed and "--resume" in printed
    record = files.load_record(workspace / "result")
    expected = dd.simulate(model(), 20, record=["u.activation"], every=5)
    n = record.sizes["time"]
    assert 0 < n < 5 and record["u.activation"].equals(expected["u.activation"][:n])
    monkeypatch.setattr(output, "sync", lambda path: None)
    assert main(["run", "result", "--resume", "--no-progress"]) == 0
    assert files.load_record(workspace / "result")["u.activation"].equals(expected["u.activation"])


@pytest.fixture
def recorded(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A record on another disk, and the command that runs it again here."""
    with monkeypatch.context() as roomy:
        roomy.setattr(output, "sync", lambda path: None)
        dd.simulate(model(), 20, record=["u.activation"], every=5, out=workspace.parent / "old")
    return ["run", str(workspace.parent / "old"), "--out", "result", "--no-progress"]


def test_without_a_terminal_a_repetition_is_written_to_the_user_data_folder(
    workspace: Path, recorded: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(recorded) == 1
    printed = capsys.readouterr()
    assert "No space left on device" in printed.err and not printed.out
    stored = sorted((workspace.parent / "data").rglob("record.zarr"))
    assert len(stored) == 1 and str(stored[0].parent) in printed.err and "deodar plot" in printed.err
    expected = dd.simulate(model(), 20, record=["u.activation"], every=5)
    assert files.load_record(stored[0].parent)["u.activation"].equals(expected["u.activation"])
    assert dd.load(stored[0].parent / "model.json").document == model().document
    assert [p.name for p in workspace.iterdir()] == ["small.json"]


def test_json_states_the_path_where_the_record_was_written_instead(
    workspace: Path, recorded: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*recorded, "--json"]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert Path(answer["record"]).exists() and answer["instead_of"] == "result" and answer["complete"]


def test_the_temporary_folder_is_the_second_choice(
    workspace: Path, recorded: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    (workspace.parent / "data" / "deodar").write_text("in the way")
    assert main(recorded) == 1
    assert len(list((workspace.parent / "temporary").rglob("record.zarr"))) == 1
    assert str(workspace.parent / "temporary") in capsys.readouterr().err


def test_the_user_is_asked_for_a_folder_until_one_can_be_written(
    workspace: Path, recorded: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        sys,
        "stdin",
        Terminal(f"{workspace}\n{workspace.parent / 'nowhere'}\n{workspace.parent / 'second'}\n"),
    )
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(recorded) == 1
    printed = capsys.readouterr().err
    assert printed.count("Another folder") == 3 and "does not exist" in printed
    assert (workspace.parent / "second" / "result-001" / "record.zarr").is_dir()


def test_an_empty_answer_writes_to_the_user_data_folder(
    workspace: Path, recorded: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", Terminal("\n"))
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(recorded) == 1
    assert len(list((workspace.parent / "data").rglob("record.zarr"))) == 1


def test_if_no_folder_can_be_written_the_error_names_all_of_them(
    workspace: Path, recorded: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (workspace.parent / "data" / "deodar").write_text("in the way")
    monkeypatch.setattr("tempfile.tempdir", str(workspace))
    assert main(recorded) == 1
    printed = capsys.readouterr().err
    assert "result" in printed and str(workspace.parent / "data") in printed and "is lost" in printed


def test_a_record_that_its_format_cannot_hold_is_kept_as_zarr(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(output, "sync", lambda path: None)
    monkeypatch.setattr(files.netcdf, "LARGEST", 10)
    assert main([*RUN, "--format", "netcdf"]) == 1
    assert "NetCDF 3 holds" in capsys.readouterr().err
    assert files.load_record(workspace / "result" / "record.zarr").sizes["time"] == 5


def test_a_demo_that_cannot_be_written_is_written_to_the_user_data_folder(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    claims = [Claim("arrives", 1, "1", True, "required", n=1, origin="ours")]
    demonstration = Demonstration(claims, {}, "spa.png", "The robot arrived.", lambda folder: None)
    monkeypatch.setattr(demo, "run", lambda args, show: demonstration)
    assert main(["demo", "spa", "--out", "planned"]) == 1
    printed = capsys.readouterr()
    (place,) = (workspace.parent / "data").rglob("planned-001")
    assert (place / "results.json").is_file() and "The robot arrived." in printed.out
    assert "No space left on device" in printed.err and str(place) in printed.err
    assert main(["demo", "spa", "--out", "planned", "--json"]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert answer["instead_of"] == "planned" and Path(answer["out"]).name == "planned-002"
    assert [p.name for p in workspace.iterdir()] == ["small.json"]
