"""Pictures of the camera at times of a run."""

from __future__ import annotations

import math

import numpy as np

from deodar_papers.serial_order.arenas import random_arena
from deodar_papers.serial_order.colours import rgb
from deodar_papers.serial_order.runs import TaughtRun
from deodar_papers.serial_order.teaching import BRIEF, brief_lesson
from deodar_papers.serial_order.views import AT_ONCE, camera_views

MIDDLE = (slice(40, 80), slice(70, 90))


def share(picture: np.ndarray, letter: str) -> float:
    """Return the share of pixels that are nearly of the colour of a letter."""
    return float((np.abs(picture - rgb(letter)).max(axis=-1) < 0.25).mean())


def test_a_view_has_the_block_that_is_shown_and_later_those_of_the_arena() -> None:
    lesson, taught = brief_lesson("RB")
    run = TaughtRun("RB", lesson, taught, random_arena("RB", (3,)))
    block = run.arena.blocks[0]
    x, y = block.center
    before = (x - 110.0, y, 0.0)
    first, second = lesson
    times = np.array([0.0, first.begins + 10, first.ends - 10, first.ends + 10, second.ends - 10, taught])
    poses = np.array([run.arena.start] * 5 + [before])
    none, aside, red, between, blue, producing = camera_views(run, taught, times, poses)
    assert first.ends - first.begins == BRIEF
    assert none.picture.shape == (120, 160, 3)
    assert none.blocks == between.blocks == ()
    assert [b.letter for v in (aside, red, blue) for b in v.blocks] == ["R", "R", "B"]
    assert producing.blocks == run.arena.blocks
    assert share(none.picture, "R") < 0.02
    assert share(red.picture[MIDDLE], "R") > 0.9
    assert share(blue.picture[MIDDLE], "B") > 0.9
    assert share(aside.picture[MIDDLE], "R") < 0.1 < share(aside.picture, "R")
    assert share(producing.picture[MIDDLE], block.letter) > 0.9


def test_views_of_many_times_are_those_of_each() -> None:
    lesson, taught = brief_lesson("G")
    run = TaughtRun("G", lesson, taught, random_arena("G", (1,)))
    count = AT_ONCE + 2
    times = np.linspace(0, taught + 100, count)
    poses = np.array([(0.0, 0.0, 2 * math.pi * k / count) for k in range(count)])
    views = camera_views(run, taught, times, poses)
    (last,) = camera_views(run, taught, times[-1:], poses[-1:])
    assert len(views) == count
    greys = [np.median(v.picture, axis=(0, 1)) for v in (views[-1], last)]
    assert np.allclose(*greys) and views[-1].blocks == last.blocks == run.arena.blocks
    differs = [np.mean(np.abs(v.picture - last.picture) > 0.3) for v in (views[-1], views[5])]
    assert differs[0] < 0.1 < differs[1]  # outliers alone; another direction
