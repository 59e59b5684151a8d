"""Two sequences are taught, and one is cued; the cue changes while an item is searched."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from deodar.experiments.trial import Trial
from deodar_papers.serial_order import cued, runs, trials
from deodar_papers.serial_order.arenas import ring
from deodar_papers.serial_order.conditions import CuedCondition, conditions, mixed, second_begins, taught
from deodar_papers.serial_order.cued import AFTER, NEVER, CuedRun
from deodar_papers.serial_order.runs import COARSE, Settings
from deodar_papers.serial_order.teaching import brief_lesson

KNOWN = {name: c for name, c in conditions(False).items() if isinstance(c, CuedCondition)}


def on_the_ring(pair: tuple[str, str], cue: int, position: int = 0) -> CuedRun:
    (first, begins), (second, lasts) = map(brief_lesson, pair)
    lesson = [*first, *(s.later(begins) for s in second)]
    sequence = mixed(pair[cue - 1], pair[2 - cue], position) if position else pair[cue - 1]
    return CuedRun(sequence, lesson, begins + lasts, ring(), pair, begins, cue, position)


def test_a_new_cue_continues_with_the_other_sequence_at_the_present_position() -> None:
    run = on_the_ring(("GBY", "RV"), 1, 2)
    assert run.sequence == "GV" and run.positions == 3
    actions = [*trials.actions(conditions(True)["ring"], run), *cued.cues([run])]
    settings = Settings(limit=30_000.0, coarse=True, cues=2, actions=actions)
    [(trial, produced)] = runs.run_many([run], settings)
    row = cued.cued_row(run, trial, produced)
    assert (row["changed"], row["produced"], row["outcome"]) == (2, "GV", "complete")


@pytest.mark.parametrize("name", ["cued", "cued-changed"])
def test_both_cues_and_positions_occur_and_the_sequences_differ_everywhere(name: str) -> None:
    c = KNOWN[name]
    assert c.count == 50
    assert {(c.cue(k), c.position(k)) for k in range(c.count)} == set(
        itertools.product((1, 2), (2, 3) if c.changed else (0,))
    )
    for k in range(c.count):
        first, second = c.pair(k)
        assert all(a != b for a, b in zip(first, second, strict=False)) and len(c.sequence(k)) >= 3
        blocks = {b.letter for b in c.arena(k).blocks}
        assert blocks >= {*first, *second}
        if c.changed:
            assert not any(a == b for s in (first, second) for a, b in itertools.pairwise(s))


def test_the_second_lesson_follows_the_first_one() -> None:
    c, k = KNOWN["cued"], 3
    showings, lasts = taught(c, k)
    assert "".join(s.letter for s in showings) == "".join(c.pair(k))
    times = [t for s in showings for t in (s.begins, s.centred, s.ends)]
    begins = second_begins(c, k)
    assert times == sorted(times) and lasts > times[-1]
    assert showings[len(c.pair(k)[0]) - 1].ends < begins < showings[len(c.pair(k)[0])].begins


def test_each_run_of_a_batch_gets_its_own_cues() -> None:
    batch = [on_the_ring(("GBY", "RVY"), cue, position) for cue, position in ((1, 2), (2, 2), (1, 3), (2, 3))]
    shorter = replace(batch[0], taught=batch[0].taught - 1000.0, second=batch[0].second - 1000.0)
    timed = [(a.time(k), a.path, a.value, a.when) for a in cued.cues([*batch, shorter]) for k in range(5)]
    produced = runs.end_of_lessons(batch)
    lessons = [t for t, _, value, when in timed if value == 2.0 and not when]
    assert len(set(lessons)) == 1 and abs(lessons[0] - (produced - 10_000.0)) <= COARSE
    begun = [t for t, _, value, when in timed if value == 1.0 and not when]
    assert begun == [produced, NEVER, produced, NEVER, produced]
    for position, cue, row in ((2, 2.0, (0, 4)), (2, 1.0, (1,)), (3, 2.0, (2,)), (3, 1.0, (3,))):
        times = [t for t, _, value, when in timed if when == f"looks for {position}" and value == cue]
        assert times == [AFTER if k in row else NEVER for k in range(5)]


def test_the_row_states_at_which_position_the_cue_changed() -> None:
    """The cue changes when the third node is active, because the second block was found at once."""
    run = on_the_ring(("GBY", "RVG"), 1, 2)
    times = np.arange(0.0, 2000.0, COARSE)
    v = {f"item {k}.node.activation": np.full(len(times), -1.0) for k in (1, 2, 3, 4)}
    for k, begin, end in ((1, 300.0, 500.0), (2, 600.0, 900.0), (3, 1000.0, 1500.0), (4, 1600.0, 2000.0)):
        v[f"item {k}.node.activation"][(times >= begin) & (times < end)] = 1.0
    v |= {
        f"strongest {name}.output": np.full(len(times), -1.0) for name in ("action", "satisfaction", "peak")
    }
    v |= {f"hue of {name}.output": np.full(len(times), 0.0) for name in ("action", "satisfaction")}
    v |= {"pose.output": np.zeros((len(times), 3)), "touching.output": np.zeros(len(times))}
    row = cued.cued_row(run, Trial(times, v, {"looks for 2": 600.0}, "over"), 0.0)
    assert (row["changed"], row["sequence"], row["taught"]) == (3, "GBG", ["GBY", "RVG"])
    never = cued.cued_row(run, Trial(times, v, {"looks for 2": None}, "time"), 0.0)
    assert (never["changed"], never["sequence"]) == (None, "GVG")
