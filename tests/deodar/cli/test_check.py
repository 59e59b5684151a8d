"""`deodar check FILE`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar import cli

X = dd.Axis("x", 0, 10, samples=11)


def _good(path: Path) -> Path:
    model = dd.Model("m")
    (
        model.add(dd.GaussianStimulus("left", [X], center=5, amplitude=4))
        >> dd.Gain(2)
        >> model.add(dd.Field("u", [X]))
    )
    dd.save(model, path)
    return path


def _bad(path: Path) -> Path:
    model = dd.Model("m")
    model.add(dd.Field("u", [X])) >> model.add(dd.Field("v", [dd.Axis("y", 0, 1, 3)]))
    model.add(dd.Gain(2, name="loose"))
    dd.save(model, path)
    return path


def test_check_of_a_valid_document_prints_its_size(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = _good(tmp_path / "m.json")
    assert cli.main(["check", str(path)]) == 0
    assert capsys.readouterr() == (f"{path}: good. 3 elements, 2 connections.\n", "")


def test_a_document_with_problems_lists_them_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", str(_bad(tmp_path / "m.json"))]) == 1
    out, err = capsys.readouterr()
    lines = out.splitlines()
    assert len(lines) == 2 and not err
    assert lines[0].startswith("v: u.output [x 0..10, 11 samples] does not fit v.input [y 0..1, 3 samples]")
    assert (
        "Write: u >> Weights(w, [y]) >> v" in lines[0]
        and "u >> Project([y]) >> v loses the signal" in lines[0]
    )
    assert lines[1].startswith("loose: nothing is connected to loose.input")


def test_json_of_a_valid_document_has_no_problems(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", str(_good(tmp_path / "m.json")), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"problems": []}


def test_json_lists_the_problems_of_a_document(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["check", str(_bad(tmp_path / "m.json")), "--json"]) == 1
    problems = json.loads(capsys.readouterr().out)["problems"]
    assert [p["where"] for p in problems] == ["v", "loose"]
    assert all(set(p) == {"severity", "where", "what", "fix"} and p["fix"] for p in problems)


def test_json_of_a_file_that_cannot_be_read_lists_its_problems_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "m.json"
    path.write_text('{"deodar": 1, "elements": {"u": {"kind": "Field", "tua": 1}, "v": {"kind": "Feild"}}}')
    assert cli.main(["check", str(path), "--json"]) == 1
    out, err = capsys.readouterr()
    assert len(json.loads(out)["problems"]) == 2 and not err


def test_check_writes_no_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _good(tmp_path / "m.json")
    before = sorted(tmp_path.iterdir())
    cli.main(["check", str(tmp_path / "m.json")])
    assert sorted(tmp_path.iterdir()) == before
    capsys.readouterr()


def _doubtful(path: Path) -> Path:
    model = dd.Model("m")
    model.add(dd.GaussianStimulus("left", [X], center=5, amplitude=6, windows=[(100, 100)])) >> model.add(
        dd.Field("u", [X])
    )
    dd.save(model, path)
    return path


def test_warnings_are_listed_and_leave_the_status_at_0(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = _doubtful(tmp_path / "m.json")
    assert cli.main(["check", str(path)]) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert (
        first.startswith("warning: left: ")
        and last == f"{path}: no problem, 1 warning. 2 elements, 1 connections."
    )


def test_strict_counts_warnings_as_problems(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = _doubtful(tmp_path / "m.json")
    assert cli.main(["check", str(path), "--strict"]) == 1
    assert capsys.readouterr().out.startswith("warning: left: ")
    assert cli.main(["check", str(path), "--strict", "--json"]) == 1
    (problem,) = json.loads(capsys.readouterr().out)["problems"]
    assert problem["severity"] == "warning" and problem["where"] == "left"
    assert cli.main(["check", str(_good(tmp_path / "good.json")), "--strict"]) == 0
