"""Names that say nothing of what they name are counted, and their numbers only fall."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import names


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("found = 1", ["found"]),
        ("found_peaks = peaks_found = 1", []),
        ("def given(own, *, _kept=1): pass", ["given", "own", "_kept"]),
        ("class A:\n    x.held = 1\n    y.axes = 2", ["held"]),
        ("for item in 3: print(item)", ["item"]),
        ("f = lambda what: what", ["what"]),
        ("left = 1", ["left"]),
        ("left, right = 1, 2", []),
        ("left = 1\ndef f():\n    right = 2", ["left"]),
        ("found, lost = 1, 2", []),
    ],
)
def test_names_that_are_given_and_say_nothing_are_found(text: str, words: list[str]) -> None:
    assert [name.text for name in names.offenders(text)] == words


def test_files_are_counted_by_folder() -> None:
    assert names.folder(ROOT / "src/deodar/model/checks/units.py") == "src/deodar/model"
    assert names.folder(ROOT / "src/deodar/errors.py") == "src/deodar"
    assert names.folder(ROOT / "tools/names.py") == "tools"


def test_limits_are_read_as_they_were_written(tmp_path: Path) -> None:
    names.write({"b": 2, "a": 1, "none": 0}, tmp_path / "names.csv")
    assert names.limits(tmp_path / "names.csv") == {"a": 1, "b": 2}


def test_a_folder_above_its_limit_fails_and_writing_lowers_alone(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(names, "counted", lambda: names.Counter({"a": 3, "b": 1, "c": 0}))
    monkeypatch.setattr(names, "limits", lambda: {"a": 2, "b": 4})
    monkeypatch.setattr(names, "write", lambda numbers: written.append(numbers))
    written: list[dict[str, int]] = []
    monkeypatch.setattr(sys, "argv", ["names.py", "--write"])
    assert names.main() == 1
    assert "a: 3 names that say only how a value came, 2 are allowed" in capsys.readouterr().out
    assert written == [{"a": 2, "b": 1, "c": 0}]
