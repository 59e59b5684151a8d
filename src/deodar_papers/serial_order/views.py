"""What the camera of the vehicle shows at times of a run, for videos: the run stores the poses alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from deodar.architectures.color_search import COLUMNS, ROWS, column_axis
from deodar.numerics.axes import Axis
from deodar_papers.serial_order.arenas import Block
from deodar_papers.serial_order.runs import TaughtRun
from deodar_papers.serial_order.world import SIDES, placed, world

AT_ONCE = 25
"""Pictures that are computed in one call."""

METRES = (0.001, 0.001, 1.0)
"""Factors of x, y and heading to metres and rad."""


@dataclass(frozen=True)
class CameraView:
    """What was around the vehicle at a time of a run.

    Attributes:
        blocks: the blocks that were present.
        picture: the picture of the camera: rows from the top, columns from the left, and red, green and blue,
            0 to 1; with the noise of the camera.
    """

    blocks: tuple[Block, ...]
    picture: np.ndarray


def camera_views(
    run: TaughtRun, begins: float, times: np.ndarray, poses: np.ndarray, seed: int = 0
) -> list[CameraView]:
    """Compute what the camera shows at times of a run.

    Args:
        run: the run; times of its lesson are those of `times`.
        begins: time from which the blocks of the arena are present, ms.
        times: times, ms.
        poses: x and y (mm) and heading (rad) of the vehicle at these times.
        seed: seed of the noise of the camera; it is not that of the run.
    """
    blocks = [_present(run, begins, float(time)) for time in times]
    pictures: list[np.ndarray] = []
    for first in range(0, len(times), AT_ONCE):
        # as many in the last call as in all others, so that they share one program
        chosen = np.minimum(np.arange(first, first + AT_ONCE), len(times) - 1)
        around = [replace(run.arena, blocks=blocks[k]) for k in chosen]
        made = world(around, [()] * AT_ONCE, 0.0)
        # not checked like a start: the vehicle may touch what it was driven to
        made.starts = np.asarray(poses, float)[chosen] * METRES
        made.reset(seed + first, range(AT_ONCE))
        axes = (column_axis(COLUMNS), Axis("row", 0, ROWS - 1, ROWS), Axis("channel", 0, 2, 3))
        pictures += list(np.swapaxes(made.sense("camera", axes, 0.0), 1, 2))
    return [CameraView(b, p) for b, p in zip(blocks, pictures, strict=False)]


def _present(run: TaughtRun, begins: float, time: float) -> tuple[Block, ...]:
    """Return the blocks at a time: those of the arena while producing, else the one that is shown."""
    if time >= begins:
        return tuple(run.arena.blocks)
    shown: Sequence[Block] = [
        Block(showing.letter, center)
        for showing in run.lesson
        for center, _, (start, stop) in (placed(run.arena, showing, side) for side in SIDES)
        if start <= time < stop
    ]
    return tuple(shown)
