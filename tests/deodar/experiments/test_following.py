"""The standing of an experiment from its rows, and the rows that another process adds."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from deodar.errors import RecordError
from deodar.experiments import row_line
from deodar.experiments.following import QUIET_SECONDS, RowsTail, RowsWriter, standing
from deodar.experiments.rows import Rows


def row(trial: int, place: str, duration: float | None, outcome: str = "found") -> dict[str, Any]:
    lost = {} if duration is not None else {"diverged": "u.activation at 3 ms"}
    levels = {"place": place, "gain": 0.5}
    return {
        "key": f"{trial:06}",
        "trial": trial,
        "levels": levels,
        "outcome": outcome,
        "awaited": "",
        "duration": duration,
        "events": {},
        "measures": {},
        **lost,
    }


ROWS = [row(0, "near", 10.0), row(1, "near", 30.0, "time"), row(2, "far", 50.0), row(3, "far", None)]


def test_the_slowest_cell_and_those_that_diverge_are_named() -> None:
    progress = standing(ROWS, 8, (100.0, 2), 110.0)
    assert (progress.rows, progress.of, progress.share, progress.left) == (4, 8, 0.5, 20.0)
    assert progress.slowest == "place far, gain 0.5, median 50"
    assert progress.diverged == ("place far, gain 0.5, 1 of 2",)
    assert [cell.cut for cell in progress.cells] == [0, 1]


def test_without_rows_or_factors_words_are_still_sentences() -> None:
    assert standing([], 8).slowest == "" and standing([], 8).left is None
    alone = standing([{**row(0, "near", None), "levels": {}}], 1)
    assert alone.slowest == "all trials, median nan" and alone.diverged == ("all trials, 1 of 1",)
    assert math.isnan(alone.cells[0].duration)


def test_the_tail_of_a_file_returns_each_row_once(tmp_path: Path) -> None:
    rows = Rows(tmp_path / "trials.jsonl", {"name": "one"})
    tail = RowsTail(rows.path)
    assert tail.new() == []
    rows.append(ROWS[:2])
    assert tail.new() == ROWS[:2] and tail.new() == []
    line, *others = (
        row_line.write(row, True).decode()
        for row in (ROWS[2], ROWS[0], ROWS[3], {**ROWS[3], "outcome": None})
    )
    with rows.path.open("a") as file:
        file.write(line[:20])
    assert tail.new() == [], "the last line is not complete"
    with rows.path.open("a") as file:
        file.write(line[20:] + others[0])
    assert tail.new() == [ROWS[2]], "a row that exists is left out"
    with rows.path.open("a") as file:
        file.write(others[1] + others[2])
    for _ in range(2):
        with pytest.raises(
            RecordError, match=r"line 7 is not a row of its experiment: outcome\. Remove that"
        ):
            tail.new()


def test_a_file_that_holds_no_rows_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="its rows cannot be read"):
        RowsTail(tmp_path / "none").new()
    for text in ("no row\n", "1\n"):
        (tmp_path / "other").write_text(text)
        with pytest.raises(RecordError, match="its rows cannot be read"):
            RowsTail(tmp_path / "other").new()


def test_rows_that_arrive_show_a_process_whose_lock_is_not_seen() -> None:
    writer, moment = RowsWriter(), 100.0
    assert not writer.runs(None, False, moment)
    assert writer.runs(None, True, moment) and writer.runs(None, False, moment + 0.9 * QUIET_SECONDS)
    assert not writer.runs(None, False, moment + QUIET_SECONDS)
