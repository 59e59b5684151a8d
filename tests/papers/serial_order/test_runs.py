"""Sequences are taught and produced: on the ring, where nothing has to be searched, and read from weights."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deodar.errors import ParameterError
from deodar.papers.serial_order import conditions, trials
from deodar.papers.serial_order.arenas import Block, SearchArena
from deodar.papers.serial_order.reasons import reason
from deodar.papers.serial_order.runs import FAR, Settings, TaughtRun, distance, read_weights, run_many
from deodar.papers.serial_order.targets import ordered
from deodar.papers.serial_order.teaching import lesson

RING = conditions.conditions(True)["ring"]


@pytest.mark.parametrize("batch", trials.batches(RING), ids=lambda batch: RING.sequence(batch[0]))
def test_a_sequence_is_taught_and_produced_on_the_ring(batch: tuple[int, ...]) -> None:
    for row in trials.run("ring", True, batch):
        assert row["outcome"] == "complete" and row["produced"] == row["sequence"]
        assert max(row["distances"]) <= FAR
        assert len(row["transitions"]) == len(row["sequence"])
    # sampled every 20 ms: only the order of what is far apart
    assert all(t[4] is not None and t[0] <= 0 < t[4] for t in row["transitions"])


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


def test_a_block_that_is_never_in_the_middle_is_not_learned_and_the_run_ends_with_this_reason() -> None:
    showings, taught = lesson("R", 3, 2.0)
    aside = [replace(s, centred=s.ends) for s in showings]
    arena = SearchArena(600.0, (Block("R", (200.0, 0.0)),), (0.0, 0.0, 0.0))
    run = TaughtRun("R", aside, taught, arena)
    settings = Settings(limit=8000.0, coarse=True, ends_unlearned=True)
    [(trial, produced)] = run_many([run], settings)
    assert trial.outcome == "nothing learned" and trial.times[-1] < produced + 4000.0
    assert reason(run, trial, produced) == "item 1 of 1 has learned no colour"


def test_a_distance_is_that_of_a_block_of_the_colour_in_the_middle_of_the_picture() -> None:
    arena = SearchArena(600.0, (Block("R", (150.0, 0.0)), Block("G", (0.0, 150.0))), (0.0, 0.0, 0.0))
    assert distance(arena, "R", np.zeros(3)) == pytest.approx(125.0)
    assert distance(arena, "G", np.zeros(3)) == np.inf
    assert distance(arena, "G", np.asarray([0.0, 0.0, np.pi / 2])) == pytest.approx(125.0)
    assert distance(arena, "R", np.asarray([0.0, 0.0, np.pi])) == np.inf


@pytest.mark.parametrize(
    ("transition", "right"),
    [
        ([-8.0, 28.0, 32.0, 44.0, 84.0, 88.0], True),
        ([0.0, 28.0, None, 44.0, 84.0, None], True),
        ([-8.0, 48.0, 32.0, 44.0, 84.0, 88.0], False),
        ([4.0, 28.0, 32.0, 44.0, 84.0, 88.0], False),
        ([None, 28.0, 32.0, 44.0, 84.0, 88.0], False),
        ([-8.0, 28.0, 32.0, 90.0, 84.0, 88.0], False),
    ],
)
def test_the_order_of_a_transition(transition: list[float | None], right: bool) -> None:
    assert ordered(transition) is right
