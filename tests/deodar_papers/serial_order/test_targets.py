"""Claims on serial order: each required one holds for good rows, and fails for a row with its fault."""

from __future__ import annotations

from typing import Any

import pytest

from deodar.analysis.claims import Claim
from deodar_papers.serial_order import conditions, tables, targets
from deodar_papers.serial_order.targets import RowsOfConditions

ORDERED = [-8.0, 28.0, 32.0, 44.0, 84.0, 88.0]
LAST = [*ORDERED[:5], None]
GOOD: dict[str, Any] = {
    "sequence": "RG",
    "produced": "RG",
    "outcome": "complete",
    "nodes": [1, 2],
    "found": [2.0, 70.0],
    "actions": [2.0, 68.0],
    "distances": [90.0, 110.0],
    "left": [False, True],
    "chosen": [1, 1],
    "transitions": [ORDERED, LAST],
    "touching": 0.0,
    "length": 500.0,
}
LEARNED: dict[str, Any] = {"sequence": "RG", "learned": "RG-", "right": True, "weights": [[1.0, 5, 0.0]]}

IN_ARENAS = "production in arenas without an error of order"
COMPLETE = "production complete within 600 s"
TRANSITIONS = "all transitions in the order of section 4.4"
RING = "production on the ring"
AWAY = "a block is taken away for 60 s"
ONE = "three duplicates of wanted blocks: one is chosen"
DUPLICATES = "three duplicates of wanted blocks: no error"
ANY = "no error of order in any arena"
LESSON = "a sequence is learned"


def rows(condition: str = "", **fault: Any) -> RowsOfConditions:
    """Return twenty good rows of each condition; those of one condition begin with a faulty row."""
    out: dict[str, list[dict[str, Any]]] = {}
    for name in conditions.conditions(False):
        good = LEARNED if name in ("learning", "clutter") else GOOD
        out[name] = [dict(good) for _ in range(20)]
        if name == condition:
            out[name][0] |= fault
    return out


def required(by_condition: RowsOfConditions) -> dict[str, Claim]:
    """Return the required claims by name."""
    return {c.name: c for c in targets.claims(by_condition, False) if c.kind == "required"}


def test_every_required_claim_holds_for_good_rows() -> None:
    claims = required(rows())
    assert {name: c.holds for name, c in claims.items()} == dict.fromkeys(claims, True)
    assert next(c.n for name, c in claims.items() if name == TRANSITIONS) == 40, "two transitions of each run"


@pytest.mark.parametrize(
    ("condition", "fault", "fails"),
    [
        ("learning", {"right": False}, [LESSON]),
        ("clutter", {"right": False}, [LESSON]),
        ("arena", {"outcome": "wrong"}, [IN_ARENAS, ANY]),
        ("arena", {"transitions": [ORDERED, [-8.0, 28.0, 32.0, 44.0, None, None]]}, [TRANSITIONS]),
        ("arena", {"transitions": [LAST, LAST]}, [TRANSITIONS]),
        ("arena", {"transitions": [[4.0, *ORDERED[1:]], LAST]}, [TRANSITIONS]),
        ("ring", {"outcome": "unfinished", "produced": "R"}, [RING]),
        ("removed", {"outcome": "unfinished", "produced": "R"}, [AWAY]),
        ("removed", {"actions": [2.0, 40.0]}, [AWAY]),
        ("removed", {"outcome": "wrong"}, [AWAY, ANY]),
        ("duplicates", {"outcome": "wrong"}, [DUPLICATES, ANY]),
        ("duplicates", {"chosen": [1, 2]}, [ONE]),
        ("ten", {"outcome": "wrong"}, [ANY]),
        ("cued", {"outcome": "wrong"}, [ANY]),
        ("carried", {"outcome": "wrong"}, [ANY]),
    ],
)
def test_one_faulty_row_fails_its_claims_alone(
    condition: str, fault: dict[str, Any], fails: list[str]
) -> None:
    claims = required(rows(condition, **fault))
    failed = [name for name, c in claims.items() if not c.holds]
    assert len(failed) == len(fails)
    assert all(any(name.startswith(start) for name in failed) for start in fails)


def test_more_than_five_in_a_hundred_unfinished_productions_fail() -> None:
    by_condition = rows()
    for row in by_condition["arena"][:2]:
        row |= {"outcome": "unfinished", "produced": "R"}
    assert [name for name, c in required(by_condition).items() if c.holds is False] == [COMPLETE]


def test_a_block_that_is_found_in_an_old_picture_is_no_test_of_waiting() -> None:
    by_condition = rows("removed", actions=[2.0, 0.1])
    assert next(c for name, c in required(by_condition).items() if name.startswith(AWAY)).n == 19


def test_a_vehicle_that_has_found_its_block_before_is_not_carried_elsewhere() -> None:
    by_condition = rows("carried", actions=[2.0, 0.4], outcome="unfinished")
    name = "production complete although the vehicle is carried elsewhere while it searches"
    claim = next(c for c in targets.claims(by_condition, False) if c.name == name)
    assert (claim.value, claim.n) == (1.0, 19)


def test_a_second_visit_follows_after_the_block_left_the_middle_of_the_picture() -> None:
    row = {**GOOD, "sequence": "RGGY", "left": [True, False, True, False]}
    assert targets.visits(row) == [True]
    assert targets.visits({**row, "left": [True, True, False, True]}) == [False]


def test_the_tables_count_outcomes_and_transitions() -> None:
    by_condition = rows("arena", outcome="unfinished", produced="R", found=[2.0])
    [line] = [line for line in tables.conditions(by_condition).splitlines() if line.startswith("| arena |")]
    assert line.startswith("| arena | 20 | 19 | 1 | 0 | 70.0 | 70.0 |")
    assert "| in the order of section 4.4 | 40 of 40 |" in tables.transitions(by_condition)
