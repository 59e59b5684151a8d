"""The world of a batch of runs: each run has its own arena, start and lesson."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from deodar.codec import JsonObject
from deodar.worlds.arena.arena import Arena
from deodar.worlds.arena.arena_settings import ArenaNoise, ArenaPhysics
from deodar_papers.serial_order.arenas import BLOCK, OUTSIDE, PLACES, SearchArena
from deodar_papers.serial_order.colours import rgb
from deodar_papers.serial_order.teaching import ASIDE, Showing

PERIOD, FRAMES = 20.0, 4
"""Period of the vehicle, ms, and periods in a frame of its camera."""

NOISE = ArenaNoise(hue_noise=6.0, outliers=0.04, slip=0.05)
"""Noise of the camera, the wheels and the infrared sensors (ours, as the paper states none)."""

NEVER, ALWAYS = (0.0, 0.0), 1e8
SIDES = ("side", "middle")

Lesson = Sequence[Showing]
ShownBlock = tuple[tuple[float, float], tuple[float, float, float], tuple[float, float]]


def world(
    arenas: Sequence[SearchArena], lessons: Sequence[Lesson], produced: float, clutter: float = 0.0
) -> Arena:
    """Create the world of several runs.

    Args:
        arenas: the arena of each run.
        lessons: the lesson of each run, with times of the run.
        produced: time from which the blocks of the arenas are present, ms.
        clutter: share of the background rows of the picture that strips of random colours cover.
    """
    count = max(PLACES, *(len(a.blocks) for a in arenas))
    longest = max(map(len, lessons))
    names = [f"block {k}" for k in range(count)] + [_shown(k, s) for k in range(longest) for s in SIDES]
    made = Arena(
        [_with_places(arena, names) for arena in arenas],
        np.asarray([arena.start for arena in arenas]),
        unit="mm",
        vehicle="khepera",
        physics=ArenaPhysics(PERIOD, camera_every=FRAMES),
        noise=dc.replace(NOISE, clutter=clutter),
    )
    for k in range(count):
        blocks = [a.blocks[k] if k < len(a.blocks) else None for a in arenas]
        _place(
            made,
            f"block {k}",
            [
                (OUTSIDE, (0.0, 0.0, 0.0), NEVER)
                if b is None
                else (b.center, rgb(b.letter), (produced, ALWAYS))
                for b in blocks
            ],
        )
    for k in range(longest):
        shown = [lesson[k] if k < len(lesson) else None for lesson in lessons]
        for side in SIDES:
            rows = [
                (OUTSIDE, (0.0, 0.0, 0.0), NEVER) if s is None else placed(a, s, side)
                for a, s in zip(arenas, shown, strict=True)
            ]
            _place(made, _shown(k, side), rows)
    return made


def _shown(k: int, side: str) -> str:
    return f"shown {k} at the {side}"


def _with_places(arena: SearchArena, names: Sequence[str]) -> JsonObject:
    """Return the layout of an arena with a place for each block that any run has."""
    free: list[JsonObject] = [{"name": n, "center": list(OUTSIDE), "size": [BLOCK, BLOCK]} for n in names]
    return {**arena.layout(), "blocks": list(free)}


def _place(made: Arena, name: str, rows: Sequence[Any]) -> None:
    centers, colors, windows = zip(*rows, strict=True)
    made.place(name, centers, (BLOCK, BLOCK), colors, windows)


def placed(arena: SearchArena, shown: Showing, side: str) -> ShownBlock:
    """Return middle, colour and window (ms) of a block that is shown, while it is at a side or in the
    middle.
    """
    x, y, heading = arena.start
    ahead, left = (ASIDE[0], shown.aside) if side == "side" else (shown.ahead, shown.lateral)
    ahead += BLOCK / 2
    window = (shown.begins, shown.centred) if side == "side" else (shown.centred, shown.ends)
    cos, sin = math.cos(heading), math.sin(heading)
    return (x + cos * ahead - sin * left, y + sin * ahead + cos * left), rgb(shown.letter), window
