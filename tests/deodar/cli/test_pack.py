"""`deodar pack`: one file for a document and its arrays, which every command opens."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar.cli import main


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_document_is_packed_and_unpacked(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pack", "example:spa"]) == 0
    assert [p.name for p in folder.iterdir()] == ["spa.deodar"]
    assert "deodar studio spa.deodar" in capsys.readouterr().out
    assert main(["pack", "spa.deodar", "--unpack", "--out", "apart", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["out"] == str(Path("apart") / "spa.json")
    assert sorted(p.suffix for p in (folder / "apart").iterdir()) == [".json", ".npz"]
    assert dd.load(folder / "apart" / "spa.json").document == dd.load("example:spa").document


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["pack", "nope.json"], 1, "there is no such file"),
        (["pack", "example:node", "--out", "node.zip"], 2, "ends in .deodar: --out node.deodar"),
        (["pack", "example:node", "--unpack"], 1, "is not a package"),
        (["pack", "example:node", "--out", "there.deodar"], 1, "exists already"),
    ],
)
def test_invalid_calls_of_pack_are_errors(
    words: list[str], status: int, says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "there.deodar").write_bytes(b"mine")
    try:
        found = main(words)
    except SystemExit as stopped:
        found = int(stopped.code or 0)
    assert (found, says in " ".join(capsys.readouterr().err.split())) == (status, True)
    assert (folder / "there.deodar").read_bytes() == b"mine"


def test_commands_open_a_package(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pack", "example:node"]) == 0
    assert main(["check", "node.deodar"]) == 0
    assert main(["run", "node.deodar", "--duration", "5", "--out", "run"]) == 0
    assert dd.load(folder / "run" / "model.json").document == dd.load("example:node").document
