"""The command that runs the tests while other processes are busy."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import busy


@pytest.mark.parametrize(
    ("report", "numbers"),
    [
        ("9210 passed in 1266.70s (0:21:06)\n", (9210, 0)),
        ("...\n1 failed, 9194 passed, 1 error in 953.77s (0:15:53)\n", (9194, 2)),
        ("no tests ran in 0.01s\n", (0, 0)),
    ],
)
def test_the_numbers_of_a_run_are_read_from_its_last_line(report: str, numbers: tuple[int, int]) -> None:
    assert busy.counted(report) == numbers


def test_a_file_of_several_runs_has_one_header(tmp_path: Path) -> None:
    for passed in (3, 4):
        busy.keep({"date": "2026-11-23", "commit": "abc", "passed": passed}, tmp_path / "busy.csv")
    with (tmp_path / "busy.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["passed"] for row in rows] == ["3", "4"] and list(rows[0]) == list(busy.FIELDS)


def test_busy_processes_end_with_the_block(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Each of two processes writes its id, then computes; after the block neither exists."""
    code = f"import os, pathlib; pathlib.Path({str(tmp_path)!r}, str(os.getpid())).touch()\nwhile True: pass"
    monkeypatch.setattr(busy, "COMPUTE", code)
    with busy.busy(2):
        while len(list(tmp_path.iterdir())) < 2:
            pass
    ids = [int(path.name) for path in tmp_path.iterdir()]
    assert len(ids) == 2 and not any(_computes(one) for one in ids)


def _computes(ident: int) -> bool:
    try:
        state = Path(f"/proc/{ident}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"
