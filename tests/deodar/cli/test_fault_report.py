"""`deodar doctor --report`: one text with the last error of deodar itself, without names of the user."""

from __future__ import annotations

import json
import platform
import sys
from pathlib import Path

import pytest

from deodar import last_error
from deodar.cli import check, doctor, main
from deodar.model import document_files, partial, written

SECRET = "grant-proposal"


@pytest.fixture(autouse=True)
def own_state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Keep the states of deodar in a folder of the test, and work in a folder with a telling name."""
    folder = tmp_path / SECRET
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    monkeypatch.setenv(written.STATES, str(tmp_path / "state"))
    monkeypatch.setenv("DEODAR_CACHE", str(folder / "cache"))
    return tmp_path / "state"


def fail(monkeypatch: pytest.MonkeyPatch, message: str, file: str = "model.json") -> None:
    """Let a command end with an unexpected error."""

    def run(args: object) -> int:
        try:
            return document_files.load(Path(file)).by_id()["x"]  # type: ignore[return-value]
        except Exception:
            raise RuntimeError(message)  # noqa: B904

    monkeypatch.setattr(check, "run", run)
    with pytest.raises(RuntimeError) as raised:
        main(["check", file])
    assert raised.value.__notes__ == [
        "This is an error of deodar itself. For a fault report type: deodar doctor --report"
    ]


def test_the_last_error_is_reported_with_its_traceback(
    own_state: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["doctor", "--report"]) == 0
    before = capsys.readouterr().out
    assert before.startswith("deodar ") and "last error none is kept" in before and "device" in before
    fail(monkeypatch, "the sum is NaN at step 12")
    assert (own_state / "last_error.json").stat().st_mode & 0o777 == 0o600
    assert main(["doctor", "--report"]) == 0
    text = capsys.readouterr().out
    for part in (
        "last error deodar check, deodar ",
        "deodar/model/document_files.py, line ",
        "which led to:",
        "deodar/cli/__init__.py, line ",
        "  a file of the user, line ",
        "RuntimeError: the sum is NaN at step 12",
        f"on Python {platform.python_version()}",
        "compiled programs",
        "set        DEODAR_CACHE, ",
    ):
        assert part in text, part


@pytest.mark.parametrize(
    "message",
    [
        f"cannot open '/data/{SECRET}/ann/my model.json'",
        f"{SECRET}/results.zarr is missing, and C:\\Users\\ann\\{SECRET}\\x.nc",
        "in ~/private/plan.npz: no entry",
        "the document model.json, called 'model', names private.npz",
        'File "/home/ann/private plan/go.py", line 3',
        "folder {cwd} below {home}, by {user} on {host}",
    ],
)
def test_a_report_has_no_path_and_no_name_of_the_user(
    message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(last_error.getpass, "getuser", lambda: "annabel")
    monkeypatch.setattr(platform, "node", lambda: "workhorse")
    fail(monkeypatch, message.format(cwd=Path.cwd(), home=tmp_path, user="annabel", host="workhorse"))
    assert main(["doctor", "--report"]) == 0
    text = capsys.readouterr().out
    words = (
        "grant",
        "ann/",
        "annabel",
        "workhorse",
        "private",
        "model.json",
        "'model'",
        str(tmp_path),
        "go.py",
    )
    assert not [word for word in words if word in text], text


def test_a_report_is_written_to_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--report", "report.txt"]) == 0
    assert "Wrote report.txt" in capsys.readouterr().out
    assert Path("report.txt").read_text().startswith("deodar ")
    assert main(["doctor", "--report", "report.txt"]) == 1
    assert main(["doctor", "--report", "report.txt", "--force", "--json"]) == 0
    assert "last error" in json.loads(capsys.readouterr().out)["report"]


def test_what_is_kept_is_bounded_and_damage_is_none(own_state: Path) -> None:
    def deeper(n: int) -> None:
        deeper(n + 1)

    with pytest.raises(RecursionError) as raised:
        sys.setrecursionlimit(sys.getrecursionlimit())
        deeper(0)
    last_error.note(raised.value, "test")
    last_error.note(ValueError("x" * 10**6), "test")
    assert (own_state / "last_error.json").stat().st_size < 10_000
    for content in ("{", "[]", "{}"):
        (own_state / "last_error.json").write_text(content)
        assert last_error.stated() == ""


def test_an_error_that_cannot_be_kept_is_let_go(own_state: Path) -> None:
    own_state.write_text("a file in place of the folder")
    last_error.note(ValueError("x"), "test")
    assert last_error.stated() == ""


def test_what_killed_saves_left_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with partial.file(Path("doc.json")) as beside, partial.folder(Path("r.zarr")) as folder:
        assert main(["doctor", "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["left"] == [], "they are being written"
    beside.write_bytes(b"half")
    (folder / partial.OLD).mkdir(parents=True)
    assert main(["doctor"]) == 0
    text = capsys.readouterr().out
    assert f"left over  {beside.name}, of a process that was killed. It may be removed" in text
    assert f"It holds what was replaced: {folder.name}/old" in text
    assert "left over" not in doctor.report()
