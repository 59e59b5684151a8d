"""Varied parameters: the table ranks them, and the figure draws them, from rows that are made up."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deodar.experiments.rows import Row
from deodar.figures._files import save_figure
from deodar_papers import serial_order
from deodar_papers._report import NOT_RUN
from deodar_papers.serial_order import conditions, robustness, tables
from deodar_papers.serial_order.parameters import PARAMETERS

RUNS = 20


def rows(condition: str, complete: int = RUNS, wrong: int = 0, action: float = 4.0) -> list[Row]:
    """Return the rows of a condition, of which some runs are complete and some wrong."""
    outcomes = ["complete"] * complete + ["wrong"] * wrong + ["unfinished"] * (RUNS - complete - wrong)
    return [
        {
            "condition": condition,
            "trial": k,
            "sequence": "RG",
            "produced": "RG",
            "outcome": outcome,
            "found": [action],
            "actions": [] if outcome == "unfinished" else [action],
            "distances": [],
            "transitions": [],
            "touching": 0.0,
        }
        for k, outcome in enumerate(outcomes)
    ]


def found(**changed: list[Row]) -> dict[str, list[Row]]:
    """Return the rows of all varied parameters, all complete but for some conditions."""
    none: dict[str, list[Row]] = {name: [] for name in conditions.conditions(False)}
    varied = {name: rows(name) for name in none if name.startswith("vary/")}
    return none | {"ring": rows("ring")} | varied | changed


MIXED = {
    "vary/c_4/+20": rows("vary/c_4/+20", complete=5, wrong=9),
    "vary/h_C/+20": rows("vary/h_C/+20", complete=0),
    "vary/c_A/-20": rows("vary/c_A/-20", complete=10),
    "vary/c_A/+20": rows("vary/c_A/+20", complete=10),
    "vary/c_2/-20": rows("vary/c_2/-20", complete=10),
    "vary/v_tar/-20": rows("vary/v_tar/-20", action=6.0),
}


def test_parameters_are_ranked_by_complete_runs_and_then_by_the_duration_of_an_action() -> None:
    ranked = robustness.ranked(found(**MIXED))
    assert [p.name for p in ranked[:5]] == ["h_C", "c_4", "c_A", "c_2", "v_tar"]
    assert sorted(p.name for p in ranked) == sorted(PARAMETERS)
    lines = robustness.table(found(**MIXED)).splitlines()
    assert lines[2] == "| h_C | 20 of 20 | 0 | 4.0 | 0 of 20 | 0 | none |"
    assert lines[3] == "| c_4 | 20 of 20 | 0 | 4.0 | 5 of 20 | 9 | 4.0 |"
    assert lines[6].startswith("| v_tar | 20 of 20 | 0 | 6.0 |")
    assert lines[-1] == "| none | 20 of 20 | 0 | 4.0 |  |  |  |"


def test_the_sentence_names_the_parameters_whose_runs_are_not_complete() -> None:
    said = robustness.first(found(**MIXED))
    words = "Runs are not complete with h_C (+20 %: 0 of 20), c_4 (+20 %: 5 of 20), c_A (-20 %: 10 of 20 and"
    assert said.startswith(words)
    assert said.endswith(f"All runs are complete with {len(PARAMETERS) - 4} of {len(PARAMETERS)} parameters.")
    assert robustness.first(found()).startswith("All runs are complete with")


def test_a_change_that_was_not_run_is_marked_and_a_parameter_without_runs_has_no_line() -> None:
    none = {name: [] for name in found()}
    some = none | {"vary/h_C/-20": rows("vary/h_C/-20", complete=3)}
    assert [p.name for p in robustness.ranked(some)] == ["h_C"]
    assert f"| h_C | 3 of 20 | 0 | 4.0 | {NOT_RUN} |" in robustness.table(some)
    assert robustness.table(none) == robustness.first(none) == robustness.picture(none) == NOT_RUN
    assert robustness.draw(none) == {}


def test_the_figure_has_a_line_for_each_parameter_and_its_picture_is_on_the_page(tmp_path: Path) -> None:
    drawn = robustness.draw(found(**MIXED))
    assert serial_order.PICTURES == {robustness.PICTURE: robustness.FIGURE} and list(drawn) == [
        robustness.FIGURE
    ]
    complete, action = drawn[robustness.FIGURE].axes
    assert [t.get_text() for t in complete.get_yticklabels()][:2] == ["h_C", "c_4"]
    assert [t.get_text() for t in complete.texts] == ["9 wrong"]
    points = [
        line.get_xdata() for line in action.lines if line.get_marker() == "o" and np.size(line.get_xdata())
    ]
    # without a completed action there is no duration
    assert len(points) == 2 * len(PARAMETERS) - 1
    assert np.isclose(max(float(np.ravel(x)[0]) for x in points), 6.0)
    save_figure(drawn[robustness.FIGURE], tmp_path / "figure.png")
    assert f"pictures/{robustness.PICTURE}.png" in tables.numbers(found(**MIXED))["parameters-picture"]


def test_only_whole_reports_have_the_figure() -> None:
    by_key = {f"{r['condition']}/{r['trial']}": r for many in found(**MIXED).values() for r in many}
    report = serial_order.report(by_key, False)
    assert list(report.figures) == [robustness.FIGURE] and "| h_C |" in report.tables["parameters"]
    with pytest.raises(KeyError):
        serial_order.report(by_key, True)
