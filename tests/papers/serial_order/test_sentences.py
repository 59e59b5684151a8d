"""Sentences of sections 4 and 5: their numbers follow from rows and from the parameters of the model."""

from __future__ import annotations

from deodar.papers.serial_order import conditions, sentences
from deodar.papers.serial_order.targets import RowsOfConditions

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
    found = {c.name.partition(": ")[2]: (c.value, c.n) for c in sentences.claims(rows())}
    assert found["action off, then satisfaction off: share of transitions"] == (0.5, 2)
    assert found["the cascade is one transient: median duration, ms"] == (96.0, 2)
    assert found["a block is found when it looms large: median distance, mm"] == (100.0, 2)
    assert found["the time of a search varies: longest over shortest action"] == (4.0, 2)
    assert found["around the shown action: largest deviation, samples of hue"] == (2.0, 2)


def test_numbers_of_the_model_follow_from_its_parameters() -> None:
    found = {c.name: c.value for c in sentences.claims(rows())}
    assert found["B: h_d, printed -5"] == -0.5
    assert not any("tau, ms" in name for name in found)  # as printed
    assert found["4.1: a node has an off state below 0 and an on state above 0: both states"] == [-0.5, 6.7]


def test_the_table_has_a_line_for_each_sentence_and_marks_those_without_rows() -> None:
    none = {name: [] for name in conditions.conditions(False)}
    said = sentences.claims(none)
    lines = sentences.table(said).splitlines()
    assert len(lines) == len(said) + 2
    assert any(line.startswith("| 4.4 |") and "| open |" in line for line in lines)
