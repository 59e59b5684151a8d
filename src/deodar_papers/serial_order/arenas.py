"""Arenas with coloured blocks: random ones, and a ring of blocks around the vehicle. Lengths are in mm."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deodar.codec import JsonObject

SIDE, CUT = 600.0, 100.0
"""Side of the square arena, and what its corners lack along each wall: a vehicle that is repelled by both
walls of a corner rests there.
"""

BLOCK, HEIGHT = 50.0, 70.0
"""Sides and height of a block; the walls are as tall."""

FROM_WALL, APART, FROM_START = 120.0, 140.0, 95.0
"""Smallest distances of the middle of a block from a wall, from the middle of another block (along one axis),
and from the start.
"""

WIDE = 900.0
"""Side of an arena with several duplicates, or with more than five wanted colours."""

DISTRACTORS = 2
"""Blocks of colours that are not in the sequence."""

RADIUS, RING_SIDE = 250.0, 900.0
"""Radius of the ring, and side of its arena."""

PLACES = 10
"""Places for blocks that every arena has at least, so that batches share one program."""

OUTSIDE = (SIDE, SIDE)
"""Middle of a place without a block; such a block is never present."""


@dataclass(frozen=True)
class Block:
    """A block: its colour and its middle."""

    letter: str
    center: tuple[float, float]


@dataclass(frozen=True)
class SearchArena:
    """An arena of one run: its blocks, and x, y and heading (rad) of the vehicle at the start."""

    side: float
    blocks: tuple[Block, ...]
    start: tuple[float, float, float]

    def layout(self) -> JsonObject:
        """Return the walls as a layout of the world `Arena`."""
        s = self.side / 2
        walls: list[JsonObject] = []
        for x in (-1, 1):
            for y in (-1, 1):
                for n, (w, h) in enumerate(((CUT / 3, 2 * CUT / 3), (2 * CUT / 3, CUT / 3))):
                    center = [x * (s - w / 2), y * (s - h / 2)]
                    walls.append({"name": f"corner {x} {y} {n}", "center": center, "size": [w, h]})
        return {"unit": "mm", "arena": {"x": [-s, s], "y": [-s, s], "height": HEIGHT}, "walls": list(walls)}


def random_arena(
    sequence: str, seed: Sequence[int], duplicates: int = 0, colours: Sequence[str] = "RYGBV"
) -> SearchArena:
    """Draw an arena with a block of each colour of a sequence, distractors, and duplicates of wanted colours;
    the vehicle starts in the middle with a random heading.

    Args:
        sequence: letters of the wanted colours.
        seed: seed of the draw.
        duplicates: blocks whose colour a wanted block has, too.
        colours: all colours there are; distractors have those that the sequence does not have.
    """
    rng = np.random.default_rng(tuple(seed))
    needed = sorted(set(sequence))
    others = [c for c in colours if c not in needed]
    letters = needed + [others[k % len(others)] for k in range(DISTRACTORS if others else 0)]
    letters += [needed[int(rng.integers(len(needed)))] for _ in range(duplicates)]
    side = WIDE if duplicates > 1 or len(colours) > len("RYGBV") else SIDE
    while (places := _places(rng, len(letters), side)) is None:
        pass
    blocks = tuple(Block(letter, place) for letter, place in zip(letters, places, strict=True))
    return SearchArena(side, blocks, (0.0, 0.0, float(rng.uniform(-math.pi, math.pi))))


def ring() -> SearchArena:
    """Return a ring of blocks of five colours around the vehicle, which heads for the first one."""
    colours = "RYGBV"
    angles = [2 * math.pi * k / len(colours) for k in range(len(colours))]
    blocks = [
        Block(c, (RADIUS * math.cos(a), RADIUS * math.sin(a))) for c, a in zip(colours, angles, strict=True)
    ]
    return SearchArena(RING_SIDE, tuple(blocks), (0.0, 0.0, 0.0))


def _places(rng: np.random.Generator, count: int, side: float) -> list[tuple[float, float]] | None:
    """Draw places for blocks one by one; None: one of them found no place."""
    places: list[tuple[float, float]] = []
    for _ in range(count):
        for _ in range(300):
            x, y = rng.uniform(FROM_WALL - side / 2, side / 2 - FROM_WALL, 2).tolist()
            free = all(max(abs(x - a), abs(y - b)) > APART for a, b in places)
            inside = abs(x) + abs(y) <= side - CUT - math.sqrt(2) * FROM_WALL
            if free and inside and math.hypot(x, y) > FROM_START:
                places.append((x, y))
                break
        else:
            return None
    return places
