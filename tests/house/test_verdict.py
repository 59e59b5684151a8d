"""The tests of the verdict follow from two tables alone."""

from __future__ import annotations

from tests import durations, verdict
from tests.durations import Duration

ROWS = {
    "a/test_a.py::test_kills": Duration(1.0),
    "a/test_a.py::test_beside": Duration(1.0),
    "a/test_a.py::test_costly": Duration(8.0),
    "b/test_b.py::test_alone": Duration(1.0),
    "b/test_b.py::test_one": Duration(0.5, frozenset({"b/test_b.py::made"})),
    "b/test_b.py::test_two": Duration(0.5, frozenset({"b/test_b.py::made"})),
    "b/test_b.py::made": Duration(3.0),
}
KILLS = ["a/test_a.py::test_kills"] * 2


def test_functions_with_kills_come_first_then_those_of_their_file() -> None:
    worth = verdict.scores(ROWS, KILLS)
    order = sorted(worth, key=worth.__getitem__, reverse=True)
    assert [min(unit).split("::")[1] for unit in order[:3]] == ["test_kills", "test_beside", "test_alone"]
    assert verdict.chosen(ROWS, KILLS, [], budget=2.0) == {
        "a/test_a.py::test_kills",
        "a/test_a.py::test_beside",
    }


def test_functions_that_share_a_fixture_are_taken_together_or_not_at_all() -> None:
    both = {"b/test_b.py::test_one", "b/test_b.py::test_two"}
    assert verdict.chosen(ROWS, KILLS, [], budget=6.9) & both == set()
    assert verdict.chosen(ROWS, KILLS, [], budget=7.0) >= both


def test_the_floor_is_taken_before_the_others() -> None:
    assert verdict.chosen(ROWS, KILLS, ["a/test_a.py::test_costly"], budget=9.0) == {
        "a/test_a.py::test_costly",
        "a/test_a.py::test_kills",
    }


def test_the_tables_name_tests_that_exist_and_the_choice_keeps_the_budget() -> None:
    rows, kills, floor = durations.read(), verdict.read(verdict.KILLS), verdict.read(verdict.FLOOR)
    gone = [name for name in (*kills, *floor) if not durations.exists(name)]
    gone += [
        file
        for file in verdict.read(verdict.FLOOR, "file")
        if not (durations.FILE.parents[1] / file).is_file()
    ]
    assert not gone, f"kills.csv or floor.csv name tests or files that are gone: {gone[:5]}"
    names = verdict.chosen(rows, kills, floor)
    fixtures = {fixture for name in names for fixture in rows[name].fixtures if fixture in rows}
    assert sum(rows[name].seconds for name in names | fixtures) <= verdict.BUDGET + 0.1
