"""`deodar pack` and `deodar open`: one file for what a colleague opens, and what it holds."""

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
    assert "deodar open spa.deodar" in capsys.readouterr().out
    assert main(["pack", "spa.deodar", "--unpack", "--out", "apart", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["out"] == str(Path("apart") / "spa.json")
    assert sorted(p.suffix for p in (folder / "apart").iterdir()) == [".json", ".npz"]
    assert dd.load(folder / "apart" / "spa.json").document == dd.load("example:spa").document
    assert main(["pack", "spa.deodar", "--unpack", "--out", "apart", "--force"]) == 0


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["pack", "nope.json"], 1, "there is no such file"),
        (["pack", "example:node", "--out", "node.zip"], 2, "ends in .deodar: --out node.deodar"),
        (["pack", "there.json", "--unpack"], 1, "is not a package"),
        (["pack", "there.json", "--unpack", "--with-code"], 2, "--with-code packs modules"),
        (["pack", "example:node", "--out", "there.deodar"], 1, "exists already"),
        (["open", "nope.deodar"], 1, "there is no such file"),
    ],
)
def test_invalid_calls_are_errors(
    words: list[str], status: int, says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("there.deodar", "there.json"):
        (folder / name).write_bytes(b"mine")
    try:
        code = main(words)
    except SystemExit as stopped:
        code = int(stopped.code or 0)
    assert (code, says in " ".join(capsys.readouterr().err.split())) == (status, True)
    assert (folder / "there.deodar").read_bytes() == b"mine"


def test_commands_open_a_package(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pack", "example:node"]) == 0
    assert main(["check", "node.deodar"]) == 0
    assert main(["run", "node.deodar", "--duration", "5", "--out", "run"]) == 0
    assert dd.load(folder / "run" / "model.json").document == dd.load("example:node").document


def test_open_says_what_a_file_holds_packed_or_not(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dd.save(dd.load("example:node"), "node.json")
    assert main(["pack", "node.json"]) == 0
    capsys.readouterr()
    for name in ("node.json", "node.deodar"):
        assert main(["open", name]) == 0
        title, model, *_, last = capsys.readouterr().out.splitlines()
        assert title.startswith("a model: node.json (1 file, ") and model.split() == [
            "model",
            "node",
            "(3",
            "elements)",
        ]
        assert last == f"Next: deodar studio {name}"
        assert main(["open", name, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["kind"] == "document"
