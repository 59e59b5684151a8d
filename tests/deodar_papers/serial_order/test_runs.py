"""Sequences are taught and produced: on the ring, where nothing has to be searched, and read from weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from deodar.errors import ParameterError
from deodar.experiments.rows import Row
from deodar.experiments.trial import Trial
from deodar_papers.serial_order import conditions, trials
from deodar_papers.serial_order.arenas import Block, SearchArena
from deodar_papers.serial_order.colours import hue_of
from deodar_papers.serial_order.reasons import reason
from deodar_papers.serial_order.runs import ABSENT, FAR, Settings, TaughtRun, found, read_weights, run_many
from deodar_papers.serial_order.targets import in_order, ordered
from deodar_papers.serial_order.teaching import lesson
from deodar_papers.serial_order.world import SIDES, world


def test_a_sequence_with_a_repeated_colour_is_taught_and_produced_on_the_ring() -> None:
    ring = conditions.conditions(True)["ring"]
    [row] = trials.run("ring", True, [ring.sequences.index("RGGY")])
    assert (row["outcome"], row["produced"], row["sequence"]) == ("complete", "RGGY", "RGGY")
    assert max(row["distances"]) <= FAR
    assert len(row["transitions"]) == 4
    # sampled every 20 ms: only the order of what is far apart
    assert all(t[4] is not None and t[0] <= 0 < t[4] for t in row["transitions"])


def test_a_world_has_a_place_for_each_block_that_is_shown_and_no_other() -> None:
    arena = SearchArena(600.0, (), (0.0, 0.0, 1.0))
    names = {slot.name for slot in world([arena], [lesson("GR", 3, 2.0)[0]], 1e4).objects.slots if slot}
    places = {f"shown {k} at the {side}" for k in (0, 1) for side in SIDES}
    assert {name for name in names if name.startswith("shown")} == places


def test_the_weights_of_a_lesson_have_its_colours_in_order() -> None:
    showings, taught = lesson("GR", 3, 2.0)
    run = TaughtRun("GR", showings, taught, SearchArena(600.0, (), (0.0, 0.0, 1.0)))
    [weights] = read_weights([run], Settings())
    assert weights.shape == (3, 180)
    assert np.abs(weights[0].argmax() - 60) <= 3 and weights[0].max() > 0.9
    assert min(weights[1].argmax(), 180 - weights[1].argmax()) <= 3 and weights[1].max() > 0.9
    assert weights[2].max() < 0.3  # the node behind the sequence has learned nothing


@pytest.mark.parametrize(
    ("shown", "blocks", "says"),
    [
        ("GR", "GYB", "no block of the colour R, which the sequence GR wants.*Add a block"),
        ("GRB", "GRB", "the lesson shows 3 colours, and the sequence GR has 2"),
        ("G", "GR", "the lesson shows 1 colours, and the sequence GR has 2"),
    ],
)
def test_a_sequence_that_cannot_be_taught_or_found_is_refused(shown: str, blocks: str, says: str) -> None:
    arena = SearchArena(600.0, tuple(Block(c, (200.0, 0.0)) for c in blocks), (0.0, 0.0, 0.0))
    with pytest.raises(ParameterError, match=says):
        run_many([TaughtRun("GR", *lesson(shown, 3, 2.0), arena)], Settings())


def test_a_lesson_that_lasts_into_the_production_is_refused() -> None:
    showings, taught = lesson("GR", 3, 2.0)
    arena = SearchArena(600.0, (Block("G", (200.0, 0.0)), Block("R", (0.0, 200.0))), (0.0, 0.0, 0.0))
    late = [replace(s, ends=s.ends + 4000.0) for s in showings]
    with pytest.raises(ParameterError, match=r"still shows R when production begins.*End the lesson later"):
        run_many([TaughtRun("GR", late, taught, arena)], Settings())


def test_a_block_that_is_never_in_the_middle_is_not_learned_and_the_run_ends_with_this_reason() -> None:
    showings, taught = lesson("R", 3, 2.0)
    aside = [replace(s, centred=s.ends) for s in showings]
    arena = SearchArena(600.0, (Block("R", (200.0, 0.0)),), (0.0, 0.0, 0.0))
    run = TaughtRun("R", aside, taught, arena)
    settings = Settings(limit=8000.0, coarse=True, ends_unlearned=True)
    [(trial, produced)] = run_many([run], settings)
    assert trial.outcome == "nothing learned" and trial.times[-1] < produced + 4000.0
    assert reason(run, trial, produced) == "item 1 of 1 has learned no colour"


@pytest.mark.parametrize(
    ("transition", "right"),
    [
        ([-8.0, 28.0, 32.0, 44.0, 84.0, 88.0], True),
        ([0.0, 28.0, None, 44.0, 84.0, 84.0], True),
        ([-8.0, 48.0, 32.0, 44.0, 84.0, 88.0], False),
        ([4.0, 28.0, 32.0, 44.0, 84.0, 88.0], False),
        ([None, 28.0, 32.0, 44.0, 84.0, 88.0], False),
        ([-8.0, 28.0, 32.0, 90.0, 84.0, 88.0], False),
        ([-8.0, 28.0, 32.0, 44.0, None, None], False),
        ([-8.0, 28.0, 32.0, 44.0, 84.0, None], False),
    ],
)
def test_the_order_of_a_transition(transition: list[float | None], right: bool) -> None:
    assert ordered(transition) is right


def test_only_the_node_behind_the_sequence_has_no_action() -> None:
    transition = [-8.0, 28.0, 32.0, 44.0, 84.0, None]
    row = {"sequence": "RG", "nodes": [1, 2], "transitions": [transition, transition]}
    assert in_order(row) == [False, True]


ARENA = SearchArena(
    600.0, tuple(Block(c, (150.0, 0.0)) for c in "RGB"), (0.0, 0.0, 0.0)
)  # all in one place, so that any of them is near


def produced(
    steps: Sequence[tuple[int, str | None]], sequence: str = "RGB", arena: SearchArena = ARENA
) -> Row:
    """Return the row of a made-up production: each step is the number of a node that is active for a second,
    and the colour of the peak that switches it off, if any.
    """
    dt, count = 2.0, len(sequence) + 1
    length = round(1000.0 * (len(steps) + 3) / dt)
    t = dt * np.arange(length)
    nodes, hue = np.full((length, count), -1.0), np.full(length, ABSENT)
    action = np.full(length, -1.0)
    begin = round(400.0 / dt)
    for node, letter in steps:
        end = begin + round(1000.0 / dt)
        nodes[begin:end, node - 1] = 1.0
        action[begin + 2 : end + 14] = 1.0
        if letter is not None:
            hue[end - 4 : end + 24] = hue_of(letter)
        begin = end + 40
    nodes[begin:, count - 1] = 1.0
    values = {f"item {k + 1}.node.activation": nodes[:, k] for k in range(count)}
    values |= {
        "strongest action.output": action,
        "strongest satisfaction.output": np.where(hue == ABSENT, -1.0, 1.0),
        "strongest peak.output": (action > 0).astype(float),
        "hue of satisfaction.output": hue,
        "hue of action.output": np.full(length, hue_of("R")),
        "pose.output": np.zeros((length, 3)),
        "touching.output": np.zeros(length),
    }
    run = TaughtRun(sequence, (), 0.0, arena)
    return found(run, Trial(t, values, {}, "over"), 0.0)


def test_a_production_in_order_is_complete_and_each_transition_is_in_order() -> None:
    row = produced([(1, "R"), (2, "G"), (3, "B")])
    assert (row["outcome"], row["produced"], row["nodes"]) == ("complete", "RGB", [1, 2, 3])
    assert in_order(row) == [True, True, True]
    assert "reason" not in row


@pytest.mark.parametrize(
    ("steps", "outcome"),
    [
        ([(1, "R"), (2, "B")], "wrong"),  # another colour
        ([(1, "R"), (2, "R")], "wrong"),  # a repetition
        ([(1, "R"), (3, "B")], "wrong"),  # a node and its colour are left out
        ([(1, "R"), (3, "G"), (3, "B")], "wrong"),  # the colours are right, a node is left out
        ([(1, "R"), (1, "G")], "wrong"),  # a node is active again
        ([(1, "R"), (2, None), (3, "B")], "wrong"),  # a node ends without a peak
        ([(1, "V")], "wrong"),  # a colour that is not in the sequence
    ],
)
def test_an_error_of_order_is_wrong(steps: list[tuple[int, str | None]], outcome: str) -> None:
    assert produced(steps)["outcome"] == outcome


def test_a_distant_block_and_one_outside_of_the_middle_are_wrong() -> None:
    for center in ((250.0, 0.0), (0.0, 150.0)):
        arena = SearchArena(600.0, tuple(Block(c, center) for c in "RGB"), (0.0, 0.0, 0.0))
        assert produced([(1, "R")], arena=arena)["outcome"] == "wrong"


def test_a_node_that_is_left_out_or_active_again_is_no_transition_in_order() -> None:
    assert in_order(produced([(1, "R"), (3, "B")])) == [False, True]
    assert in_order(produced([(1, "R"), (1, "R"), (2, "G")]))[0] is False


def test_a_production_in_which_nothing_is_found_is_unfinished() -> None:
    row = produced([])
    assert (row["outcome"], row["found"], row["left"]) == ("unfinished", [], [])


def test_an_unfinished_production_states_its_reason() -> None:
    row = produced([(1, "R"), (2, "G")], "RGBV")
    # the last node is that behind the sequence, which is active without the third and fourth
    assert row["outcome"] == "unfinished" and "nodes of the sequence have been active" in row["reason"]
