"""Invalid command lines: one paragraph on stderr, status 1 or 2, and no file is written."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import deodar as dd
from deodar import cli
from tests.deodar.errors.refused import paragraph

X = dd.Axis("x", 0, 10, samples=11)

GOOD, BAD = "good.json", "bad.json"

CALLS: dict[str, tuple[list[str], int, tuple[str, ...]]] = {
    "no command": ([], 2, ("COMMAND", "deodar --help")),
    "a misspelt command": (["chek"], 2, ("there is no command called 'chek'", "Did you mean 'check'?")),
    "no such command": (["zzz"], 2, ("there is no command called 'zzz'", "Valid names: ")),
    "a command that is nothing": ([""], 2, ("there is no command called ''",)),
    "an unknown option": (["--verbos"], 2, ("deodar --help",)),
    "check: nothing": (["check"], 2, ("FILE", "Type: deodar check --help")),
    "check: an unknown option": (["check", GOOD, "--force"], 2, ("--force",)),
    "check: missing": (
        ["check", "god.json"],
        1,
        ("god.json: there is no such file", "Did you mean 'good.json'?"),
    ),
    "check: a folder": (["check", "."], 1, ("is not a file",)),
    "check: a pipe": (["check", "pipe"], 1, ("is not a file",)),
    "check: no JSON": (["check", BAD], 1, ("bad.json: is not JSON",)),
    "check: a name too long": (["check", "x" * 300], 1, ("cannot be read",)),
    "check: not readable": (["check", "unreadable.json"], 1, ("unreadable.json",)),
    "elements: misspelt": (["elements", "Feild"], 1, ("Did you mean 'Field'?",)),
    "elements: too many": (["elements", "Field", "Gain"], 2, ("unrecognized arguments: Gain",)),
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make a working folder with a valid document, a broken one, and a pipe."""
    import os

    model = dd.Model("m")
    model.add(dd.Field("u", [X]))
    dd.save(model, tmp_path / GOOD)
    (tmp_path / BAD).write_text("{")
    (tmp_path / "unreadable.json").mkdir()
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _status(argv: list[str]) -> int:
    try:
        return cli.main(argv)
    except SystemExit as stop:
        return int(stop.code or 0)


@pytest.mark.parametrize("name", CALLS)
def test_an_invalid_call_is_an_error_and_writes_nothing(
    folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    argv, status, says = CALLS[name]
    before = sorted(folder.iterdir())
    assert _status(argv) == status
    out, err = capsys.readouterr()
    assert not out
    paragraph(err)
    assert err.endswith("\n") and err.startswith("deodar")
    for piece in says:
        assert piece in err, err
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("command", ["", *cli.COMMANDS.first_party()])
def test_every_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert _status([*([command] if command else []), "--help"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("usage: deodar") and not err
    if command:
        assert cli.COMMANDS[command].HELP.split()[0] in out


def test_version_prints_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert _status(["--version"]) == 0
    assert capsys.readouterr().out == f"deodar {dd.__version__}\n"


def _raising(error: BaseException) -> Callable[..., int]:
    def run(args: object) -> int:
        raise error

    return run


@pytest.mark.parametrize(
    ("error", "says", "status"),
    [
        (KeyboardInterrupt(), "stopped", 130),
        (PermissionError(13, "Permission denied", "secret.json"), "Permission denied: secret.json", 1),
        (OSError(28, "No space left on device"), "No space left on device", 1),
        (MemoryError(), "not enough memory", 1),
        (dd.errors.MissingExtra("cv2", "vision", "the camera"), "pip install 'deodar[vision]'", 1),
    ],
)
def test_an_error_of_a_command_is_one_line(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException,
    says: str,
    status: int,
) -> None:
    monkeypatch.setattr(cli.COMMANDS["elements"], "run", _raising(error))
    assert _status(["elements"]) == status
    out, err = capsys.readouterr()
    assert not out and err.startswith("deodar elements: ") and says in err
    assert len(err.splitlines()) == 1


def test_a_real_process_shows_no_traceback(folder: Path) -> None:
    for argv, status in ((["check", BAD], 1), (["chek"], 2), (["check"], 2), (["check", GOOD], 0)):
        done = subprocess.run([sys.executable, "-m", "deodar", *argv], capture_output=True, text=True)
        assert done.returncode == status
        assert "Traceback" not in done.stderr
        assert bool(done.stderr) == bool(status)
