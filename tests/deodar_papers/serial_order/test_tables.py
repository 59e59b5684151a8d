"""Tables and lists of the manual: what they state of rows that are made up."""

from __future__ import annotations

from deodar_papers._report import NOT_RUN
from deodar_papers.serial_order import conditions, parameters, tables
from tests.deodar_papers.serial_order.test_robustness import found, rows


def test_the_list_has_the_conditions_with_runs_alone() -> None:
    repeated = [
        row | {"sequence": "GG", "actions": [2.0, 0.5], "left": [True, False]} for row in rows("repetition")
    ]
    listed = tables.outcomes(found(cued=rows("cued", complete=15, wrong=2), repetition=repeated)).splitlines()
    assert len(listed) == 2
    assert listed[0].startswith("* With two sequences") and listed[0].endswith("15 of 20, wrong 2 of 20.")
    assert listed[1] == "* A repeated colour is found at once, within 1 s: 20 of 20."
    later = [row | {"actions": [2.0, 9.0], "left": [True, k > 2]} for k, row in enumerate(repeated)]
    listed = tables.outcomes(found(repetition=later, habituation=later)).splitlines()
    assert [line.rpartition(": ")[2] for line in listed] == ["0 of 20.", "17 of 20."]


def test_reasons_of_unfinished_runs_are_counted_by_condition() -> None:
    unfinished = rows("arena")
    for row, letter in zip(unfinished, "RG", strict=False):
        row |= {"reason": f"still looking for {letter} (item 2 of 2)", "length": 5000.0}
    assert "| arena | still looking | 2 |" in tables.reasons(found(arena=unfinished))
    unfinished[0]["length"] = 500.0
    assert "| arena | still looking, on a path of less than 1 m | 1 |" in tables.reasons(
        found(arena=unfinished)
    )
    assert tables.reasons(found(arena=rows("arena"))) == NOT_RUN


def test_conditions_without_runs_are_named_and_varied_parameters_counted() -> None:
    none = {name: [] for name in found()}
    assert tables.outcomes(none) == NOT_RUN
    words = tables.without_runs(none)
    assert "`cued-changed`" in words and "vary/" not in words
    assert words.endswith(f"{2 * (len(parameters.TABLE) - 1)} conditions with a varied parameter")
    assert tables.without_runs({name: rows(name) for name in none}) == "none"


def test_every_condition_in_arenas_has_words() -> None:
    said = {*tables.OUTCOMES, "arena", "habituation", "repetition"}
    assert said == {name for name, c in conditions.conditions(True).items() if c.body == "arena"}


def test_each_value_that_differs_from_table_b1_has_a_reason() -> None:
    lines = tables.changed().splitlines()[2:]
    assert len(lines) == len(parameters.REASONS) == 10
    assert lines[0].startswith("| h_d | -5 | -0.5 | the next node") and "| c_CoS | 15 | 3 |" in lines[2]
    assert not any(line.endswith("|  |") for line in lines)
