"""Sight: which blocks of an arena are in view of the vehicle, and on which of them a peak lies."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar.architectures.color_search import PATCH
from deodar.worlds.arena.khepera import KHEPERA
from deodar.worlds.arena.vehicle import VehicleCamera
from deodar_papers.serial_order.arenas import BLOCK, Block, SearchArena

APART = 10
"""Samples of the columns (20 pixels) between two regions of the colour-space field."""


def distance(arena: SearchArena, letter: str, pose: np.ndarray) -> float:
    """Return the distance, mm, of the nearest block of a colour of which a part is in the middle of the
    picture; infinite without one.
    """
    x, y, heading = (float(coordinate) for coordinate in pose)
    widest = math.tan(_camera().horizontal / 2) * PATCH
    best = math.inf
    for block in arena.blocks:
        if block.letter != letter:
            continue
        corners = _corners(block) - [x, y]
        cos, sin = math.cos(heading), math.sin(heading)
        ahead, across = corners @ [cos, sin], corners @ [-sin, cos]
        if (ahead <= 0).any():
            continue
        slopes = across / ahead
        if slopes.min() <= widest and slopes.max() >= -widest:
            gap = np.maximum(np.abs(np.asarray([x, y]) - block.center) - BLOCK / 2, 0.0)
            best = min(best, float(np.hypot(*gap)))
    return best


def regions(columns: np.ndarray) -> list[tuple[int, int]]:
    """Return the first and last sample of each region above threshold; what is less than `APART` apart is one
    region, which noise divides.
    """
    above = np.flatnonzero(columns > 0.5)
    parts = np.split(above, np.flatnonzero(np.diff(above) > APART) + 1)
    return [(int(part[0]), int(part[-1])) for part in parts if len(part)]


def chosen(arena: SearchArena, letter: str, pose: np.ndarray, columns: np.ndarray) -> int:
    """Return the number of blocks of a colour on which the regions of the colour-space field lie.

    A region lies on the block whose directions include that of its middle, or come nearest to it. A block
    that fills the picture may have several regions.

    Args:
        arena: the arena.
        letter: the colour.
        pose: x, y (mm) and heading (rad) of the vehicle.
        columns: output of the colour-space field over the columns, its largest over hue.
    """
    x, y, heading = (float(coordinate) for coordinate in pose)
    blocks = [block for block in arena.blocks if block.letter == letter]
    numbers: set[int] = set()
    for first, last in regions(columns):
        # -1 at the left edge of the picture, 1 at the right one
        middle = (first + last + 1) / len(columns) - 1
        direction = heading - math.atan(middle * math.tan(_camera().horizontal / 2))
        distances = [_away(block, (x, y), direction) for block in blocks]
        if distances:
            numbers.add(min(range(len(distances)), key=lambda k: distances[k]))
    return len(numbers)


def _away(block: Block, place: Sequence[float], direction: float) -> tuple[float, float]:
    """Return the angle between a direction and those of a block, 0 within them, and the distance of its
    middle.
    """
    dx, dy = block.center[0] - place[0], block.center[1] - place[1]
    bearing = math.atan2(dy, dx)
    corners = _corners(block) - np.asarray(place)
    half = max(abs(_turn(math.atan2(cy, cx) - bearing)) for cx, cy in corners.tolist())
    return max(0.0, abs(_turn(direction - bearing)) - half), math.hypot(dx, dy)


def _corners(block: Block) -> np.ndarray:
    return np.asarray([[sx, sy] for sx in (-1, 1) for sy in (-1, 1)]) * BLOCK / 2 + block.center


def _turn(angle: float) -> float:
    """Return an angle between -pi and pi."""
    return math.remainder(angle, 2 * math.pi)


def _camera() -> VehicleCamera:
    camera = KHEPERA.camera
    assert camera is not None
    return camera
