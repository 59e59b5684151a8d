"""The design: sequences, lessons, arenas, and what is varied."""

from __future__ import annotations

import math

import pytest

from deodar.architectures.color_search import color_search, hue_axis
from deodar.errors import ParameterError, UnknownName
from deodar_papers import papers
from deodar_papers.serial_order import arenas, colours, conditions, parameters, teaching, trials
from deodar_papers.serial_order.arenas import random_arena


@pytest.mark.parametrize("quick", [True, False])
def test_every_run_belongs_to_one_job_whose_sequences_have_one_length(quick: bool) -> None:
    keys = [key for job in papers.PAPERS["serial-order"].jobs(quick) for key in job.keys]
    designs = conditions.conditions(quick)
    assert sorted(keys) == sorted(c.key(k) for c in designs.values() for k in range(c.count))
    for c in designs.values():
        for batch in trials.batches(c):
            assert len({len(c.sequence(k)) for k in batch}) == 1 and len(batch) <= trials.BATCH


def test_the_runs_are_as_many_as_the_claims_need() -> None:
    designs = conditions.conditions(False)
    assert designs["learning"].count + designs["clutter"].count >= 300
    assert designs["arena"].count >= 100 and designs["removed"].count >= 50
    assert designs["duplicates"].count >= 50 and designs["duplicates"].duplicates == 3
    assert {designs["arena"].sequence(k) for k in range(120)} >= {*colours.PAPER, *colours.random_sequences()}


@pytest.mark.parametrize("k", range(20))
def test_blocks_of_an_arena_are_apart_from_walls_and_from_each_other(k: int) -> None:
    arena = random_arena("RBGBY", (k,), duplicates=3)
    letters = [b.letter for b in arena.blocks]
    assert arena.side == arenas.WIDE and random_arena("RBGBY", (k,)).side == arenas.SIDE
    assert set("RBGY") <= set(letters) and len(letters) == 4 + arenas.DISTRACTORS + 3
    for n, block in enumerate(arena.blocks):
        assert max(map(abs, block.center)) <= arena.side / 2 - arenas.FROM_WALL
        for other in arena.blocks[n + 1 :]:
            assert max(abs(a - b) for a, b in zip(block.center, other.center, strict=True)) > arenas.APART


def test_a_lesson_shows_each_colour_once_at_the_side_and_then_in_the_middle() -> None:
    showings, end = teaching.lesson("RGGY", 5)
    assert "".join(s.letter for s in showings) == "RGGY"
    times = [t for s in showings for t in (s.begins, s.centred, s.ends)]
    assert times == sorted(times) and times[0] == teaching.FIRST and end > times[-1]
    assert teaching.lesson("RGGY", 5) == (showings, end) != teaching.lesson("RGGY", 6)


def test_a_factor_of_one_leaves_every_parameter_as_it_is() -> None:
    model = color_search(3)
    for name in parameters.PARAMETERS:
        for path, value in parameters.values(name, 1.0, 3).items():
            assert model.get(path) == pytest.approx(value), (name, path)
        changed = parameters.values(name, 1.2, 3)
        assert any(model.get(path) != pytest.approx(value) for path, value in changed.items()), name
    with pytest.raises(UnknownName, match="no parameter"):
        parameters.values("h_x", 1.2, 3)


def test_one_table_states_printed_values_and_those_of_the_model() -> None:
    table = {parameter.name: parameter for parameter in parameters.TABLE}
    assert len(table) == len(parameters.TABLE) == 41
    assert set(parameters.PARAMETERS) == set(table) - {"N"}
    assert (table["h_d"].printed, table["h_d"].ours) == (-5.0, -0.5)
    assert (table["c_5"].printed, table["c_5"].ours) == (2.0, 2.0)
    model = color_search(1)
    for name, path in (("c_inh", "action.global_inhibition"), ("R", "repulsion.size"), ("N", "")):
        ours = model.get(path) if path else hue_axis().samples
        assert table[name].ours == ours, name
    differ = {name for name, p in table.items() if p.printed != pytest.approx(p.ours)}
    assert differ == {"h_d", "c_inh", "c_CoS", "boost", "c_A", "h_p", "c_exc^P", "c_inh^P", "v_tar", "v_obs"}


def test_hues_are_nearest_on_their_circle() -> None:
    assert colours.letter_at(178.0) == "R" and colours.letter_at(100.0) == "B"
    assert colours.rgb("G") == pytest.approx((0.0, 0.9, 0.0))
    assert colours.away(2.0, 178.0) == 4.0 and not math.isnan(colours.hue_of("7"))
    with pytest.raises(ParameterError, match="no colour 'X'"):
        colours.hue_of("X")
