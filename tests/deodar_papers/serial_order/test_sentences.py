"""Sentences of sections 4 and 5: their numbers follow from rows and from the parameters of the model."""

from __future__ import annotations

from typing import Any

import pytest

from deodar_papers.serial_order import conditions, sentences
from deodar_papers.serial_order.targets import RowsOfConditions

ORDERED = [-4.0, 28.0, 32.0, 44.0, 84.0, 88.0]
LATE = [-8.0, 48.0, 32.0, 44.0, 84.0, 92.0]


def rows() -> RowsOfConditions:
    """Return a row of an arena and one of a lesson; no other condition has run."""
    arena = {
        "sequence": "RG",
        "produced": "RG",
        "distances": [90.0, 110.0],
        "actions": [2.0, 8.0],
        "transitions": [ORDERED, LATE],
    }
    lesson = {"right": True, "weights": [[0.9, 5, -2.0], [1.0, 7, 1.0]]}
    return {name: [] for name in conditions.conditions(False)} | {"arena": [arena], "learning": [lesson]}


def test_numbers_follow_from_the_rows() -> None:
    numbers = {c.name.partition(": ")[2]: (c.value, c.n) for c in sentences.claims(rows())}
    assert numbers["action off, then satisfaction off: share of transitions"] == (0.5, 2)
    assert numbers["the cascade is one transient: median duration, ms"] == (96.0, 2)
    assert numbers["a block is found when it looms large: median distance, mm"] == (100.0, 2)
    assert numbers["the time of a search varies: longest over shortest action"] == (4.0, 2)
    assert numbers["around the shown action: largest deviation, samples of hue"] == (2.0, 2)


def test_numbers_of_the_model_follow_from_its_parameters() -> None:
    numbers = {c.name: c.value for c in sentences.claims(rows())}
    assert numbers["B: h_d, printed -5"] == -0.5
    assert not any("tau, ms" in name for name in numbers)  # as printed
    assert numbers["4.1: a node has an off state below 0 and an on state above 0: both states"] == [-0.5, 6.7]


def test_sentences_of_the_fields_follow_from_the_parameters() -> None:
    numbers: dict[str, Any] = {
        c.name.partition(": ")[2].partition(":")[0]: c.value for c in sentences.from_parameters()
    }
    assert (
        numbers["the action field alone leaves the field of the condition of satisfaction below threshold"]
        == -0.8
    )
    assert numbers["both together lift it above threshold"] == 0.2
    # 0.9 exp(-k^2 / 18) - 0.5 sums to 0.4, 0.75, 0.97, 1.02, 0.89 over widths of 1 to 5
    assert numbers["its peak is self-stabilized"] == pytest.approx(0.2170, abs=1e-3)
    alone, largest = numbers["learning, one of several objects is selected"]
    assert alone == 200 and largest > alone
    assert numbers["attraction scales with the size of the peak"] == 2.0


def test_numbers_of_runs_and_of_parameters_are_in_tables_of_their_own() -> None:
    none = {name: [] for name in conditions.conditions(False)}
    lines = sentences.runs_table(none).splitlines()
    assert len(lines) == len(sentences.from_runs(none)) + 2
    assert all("| open |" in line for line in lines[2:])
    runs, given = sentences.runs_table(rows()), sentences.parameters_table()
    assert "| 4 | 2 |" in runs and "4.3" in given and "4.3" not in runs and "printed -5" not in given


def test_numbers_have_three_digits() -> None:
    many = {**rows(), "arena": [{**rows()["arena"][0], "actions": [0.12, 187.9235]}]}
    [line] = [line for line in sentences.runs_table(many).splitlines() if "longest over shortest" in line]
    assert line.endswith("| 1570 | 2 |")
