"""`deodar tune`: what was found in words, as JSON and as a document."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.cli import main
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, node

LEVEL = "u.resting_level"
WANTED = {
    "parameters": {LEVEL: [-8, -2], EXCITATION: None},
    "requirements": [{"detects": {"at": 3.5, "within": 0.1}}, "forgets"],
    "strength": 6,
}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dd.save(node(), "node.json")
    write(WANTED)
    return tmp_path


def write(content) -> None:
    with open("wanted.json", "w", encoding="utf-8") as file:
        json.dump(content, file)


def test_it_prints_what_was_found_and_writes_the_document(capsys):
    assert main(["tune", "node.json", "wanted.json", "--out", "tuned.json"]) == 0
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0] == "u meets all requirements" and not printed.err
    assert lines[1].startswith("Measured alone, without noise, with inputs of 6;")
    assert "detects(at=3.5, within=0.1)   at 3.5 (exact)" in printed.out and "met" in lines[3]
    assert "All at once may move by" in printed.out and lines[-1] == "Document: tuned.json"
    model = dd.load("tuned.json")
    up = dd.regimes(model, "u", accuracy=1e-3).detection
    assert up == pytest.approx(3.5, abs=4e-3) and model.get(LEVEL) != -5
    assert "for detects(at=3.5, within=0.1), forgets()." in model.document.notes
    assert main(["tune", "node.json", "wanted.json", "--out", "tuned.json"]) == 1
    assert "exists" in capsys.readouterr().err


def test_json_has_the_same_and_the_status_says_whether_it_is_met(capsys):
    write(WANTED | {"parameters": {LEVEL: [-8, -7]}, "budget": 50})
    assert main(["tune", "node.json", "wanted.json", "--json", "--seed", "4"]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert answer["met"] is False and answer["seed"] == 4 and answer["document"] is None
    assert answer["margins"]["detects(at=3.5, within=0.1)"] < 0
    assert answer["unreachable"] == ["detects(at=3.5, within=0.1)"]
    write(WANTED | {"parameters": {LEVEL: [-8, -7]}, "budget": 50})
    assert main(["tune", "node.json", "wanted.json"]) == 1
    assert "No candidate met detects(at=3.5, within=0.1)." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ([], "expected an object"),
        (WANTED | {"parameter": {}}, "Did you mean 'parameters'"),
        (WANTED | {"parameters": [LEVEL]}, "expected bounds by path"),
        (WANTED | {"requirements": []}, "expected a list"),
        (WANTED | {"requirements": ["detect"]}, "Did you mean 'detects'"),
        (WANTED | {"requirements": [3]}, "3 is no requirement"),
        (WANTED | {"requirements": [{"detects": 3}]}, "requirements.0: needs an object, not 3"),
        (WANTED | {"requirements": ["detects"]}, "a detects needs 'at'"),
        (WANTED | {"requirements": [{"detects": {"att": 1, "within": 1}}]}, "Did you mean 'at'"),
        (
            WANTED | {"requirements": [{"detects": {"at": 1, "within": 0}}]},
            "requirements.0.within: is 0",
        ),
        (WANTED | {"requirements": [{"forgets": {"kind": "rests"}}]}, "forgets has no such parameter"),
        (WANTED | {"parameters": {"u.resting_leve": None}}, "Did you mean 'resting_level'"),
        (WANTED | {"parameters": {LEVEL: [1]}}, "expected (low, high)"),
    ],
)
def test_mistakes_of_the_file_are_answered(content, message, capsys):
    write(content)
    assert main(["tune", "node.json", "wanted.json"]) == 1
    assert message in capsys.readouterr().err


def test_a_missing_file_is_answered(capsys):
    assert main(["tune", "node.json", "other.json"]) == 1
    assert "other.json" in capsys.readouterr().err
