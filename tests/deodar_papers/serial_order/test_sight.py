"""Which blocks are in view, and on which of them a peak lies."""

from __future__ import annotations

import numpy as np
import pytest

from deodar_papers.serial_order.arenas import Block, SearchArena
from deodar_papers.serial_order.sight import chosen, distance, regions

pytestmark = pytest.mark.fast


def test_a_distance_is_that_of_a_block_of_the_colour_in_the_middle_of_the_picture() -> None:
    arena = SearchArena(600.0, (Block("R", (150.0, 0.0)), Block("G", (0.0, 150.0))), (0.0, 0.0, 0.0))
    assert distance(arena, "R", np.zeros(3)) == pytest.approx(125.0)
    assert distance(arena, "G", np.zeros(3)) == np.inf
    assert distance(arena, "G", np.asarray([0.0, 0.0, np.pi / 2])) == pytest.approx(125.0)
    assert distance(arena, "R", np.asarray([0.0, 0.0, np.pi])) == np.inf


def test_noise_divides_no_region() -> None:
    columns = np.zeros(80)
    assert regions(columns) == []
    columns[10:16] = columns[18:24] = 1.0
    assert regions(columns) == [(10, 23)]
    columns[60:63] = 1.0
    assert regions(columns) == [(10, 23), (60, 62)]


def test_several_regions_on_one_block_are_one_choice_and_on_two_blocks_they_are_not() -> None:
    # one block at the left and one at the right, and a near one of another colour
    blocks = (Block("R", (200.0, 80.0)), Block("R", (200.0, -80.0)), Block("G", (-80.0, 0.0)))
    arena = SearchArena(600.0, blocks, (0.0, 0.0, 0.0))
    columns = np.zeros(80)
    assert chosen(arena, "R", np.zeros(3), columns) == 0
    columns[8:14] = 1.0
    assert chosen(arena, "R", np.zeros(3), columns) == 1
    columns[66:72] = 1.0
    assert chosen(arena, "R", np.zeros(3), columns) == 2, "left and right"
    assert chosen(arena, "G", np.asarray([0.0, 0.0, np.pi]), columns) == 1, "it fills the picture"
    assert chosen(arena, "V", np.zeros(3), columns) == 0, "no block of this colour"
    # the left block alone is in view: its directions are those of the left half
    near = np.asarray([150.0, 60.0, 0.4])
    assert chosen(arena, "R", near, columns) == 1
