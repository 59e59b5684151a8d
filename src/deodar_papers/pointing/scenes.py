"""Random scenes: coloured discs on the table. Scenes to tune parameters and scenes to test them have other
seeds.
"""

from __future__ import annotations

import colorsys
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from deodar.codec import JsonObject

HUES = {"red": 0.0, "yellow": 55.0, "green": 120.0, "cyan": 180.0, "blue": 235.0, "magenta": 300.0}
"""Hues of the objects' colours, degrees. Two of them can be cued."""

SHARES = (0.3, 0.1, 0.3, 0.1, 0.1, 0.1)
"""How often each colour is drawn: cued colours more often, so that scenes have matches."""

SPREAD = 8.0
"""Largest difference of an object's hue from that of its colour, degrees."""

SIDES = ("left", "right")
TUNING, TEST, BAND = 0, 100_000, 120_000
"""First seed of the scenes that parameters may be tuned on, of those that test them, and of those beyond the
range for which the architecture is made.
"""

FARTHEST, NEAR, FAR = 0.35, 0.06, 0.54
"""Largest distance of a centre from the midline, and its smallest and largest y, m."""

GAP = 0.05
"""Smallest distance between the edges of two objects, m."""

FEWEST, MOST, FEWEST_COLOURS = 2, 6, 4
"""Numbers of objects; a scene of at least `FEWEST_COLOURS` objects has at least that many colours."""

TRIES = 400


@dataclass(frozen=True)
class Range:
    """What objects of a scene are like: lowest and highest values.

    Attributes:
        radius: m.
        saturation: 0 to 1.
        value: brightness, 0 to 1.
        midline: distance of the centre from the midline, m.
    """

    radius: tuple[float, float] = (0.03, 0.045)
    saturation: tuple[float, float] = (0.7, 1.0)
    value: tuple[float, float] = (0.6, 0.95)
    midline: tuple[float, float] = (0.08, FARTHEST)


SERVED = Range()
"""The range of scenes for which the architecture is made."""

BEYOND = Range((0.02, 0.03), (0.5, 0.7), (0.6, 0.95), (0.04, 0.08))
"""A band outside of this range, reported and not required."""


@dataclass(frozen=True)
class Disc:
    """A coloured disc on the table.

    Attributes:
        name: name in the scene.
        colour: name of its colour.
        x, y: place of its centre, m.
        radius: m.
        hue: degrees.
        saturation, value: 0 to 1.
    """

    name: str
    colour: str
    x: float
    y: float
    radius: float
    hue: float
    saturation: float
    value: float

    @property
    def side(self) -> str:
        """The side of the table on which it lies, as the robot sees it."""
        return SIDES[int(self.x > 0)]

    @property
    def rgb(self) -> tuple[float, float, float]:
        """Red, green and blue, 0 to 1."""
        return colorsys.hsv_to_rgb(self.hue / 360, self.saturation, self.value)

    def distance(self, x: float, y: float) -> float:
        """Return the distance of a place from its centre, m."""
        return math.hypot(x - self.x, y - self.y)

    def to_data(self) -> JsonObject:
        """Return the disc as plain data."""
        return asdict(self)


def scene(
    seed: int,
    wanted: Sequence[tuple[str, str]] = (),
    count: int | None = None,
    alone: bool = False,
    served: Range = SERVED,
) -> list[Disc]:
    """Draw a scene.

    Args:
        seed: seed of the scene.
        wanted: colour and side of the first objects.
        count: number of objects; None: 2 to 6.
        alone: whether no other object has the colour and side of a wanted one.
        served: the range of the objects.
    """
    random = np.random.default_rng(seed)
    for _ in range(TRIES):
        number = max(len(wanted), int(random.integers(FEWEST, MOST + 1)) if count is None else count)
        drawn = _drawn(random, number, wanted, alone, served)
        if drawn is not None:
            return drawn
    raise ValueError(f"no scene was found for the seed {seed}")


def equal_pair(seed: int, colour: str, side: str) -> list[Disc]:
    """Draw a scene with two equal, saturated objects that match, and two others."""
    first, second, *others = scene(seed, [(colour, side)] * 2, 4, alone=True)
    like = {"saturation": 0.99, "hue": first.hue, "value": first.value, "radius": first.radius}
    return [replace(first, saturation=0.99), replace(second, **like), *others]


def _drawn(
    random: np.random.Generator,
    number: int,
    wanted: Sequence[tuple[str, str]],
    alone: bool,
    served: Range,
) -> list[Disc] | None:
    """Draw a scene once; None if the objects found no room or have too few colours."""
    found: list[Disc] = []
    while len(found) < number:
        k = len(found)
        colour, side = (
            wanted[k]
            if k < len(wanted)
            else (str(random.choice(list(HUES), p=SHARES)), str(random.choice(SIDES)))
        )
        if k >= len(wanted) and alone and (colour, side) in wanted:
            continue
        disc = _placed(random, f"{colour} {k + 1}", colour, side, found, served)
        if disc is None:
            return None
        found.append(disc)
    if not wanted and number >= FEWEST_COLOURS and len({d.colour for d in found}) < FEWEST_COLOURS:
        return None
    return found


def _placed(
    random: np.random.Generator, name: str, colour: str, side: str, others: Sequence[Disc], served: Range
) -> Disc | None:
    for _ in range(TRIES):
        radius = float(random.uniform(*served.radius))
        x = float(random.uniform(*served.midline)) * (-1 if side == "left" else 1)
        y = float(random.uniform(NEAR, FAR))
        if all(o.distance(x, y) > o.radius + radius + GAP for o in others):
            return Disc(
                name,
                colour,
                x,
                y,
                radius,
                float((HUES[colour] + random.uniform(-SPREAD, SPREAD)) % 360),
                float(random.uniform(*served.saturation)),
                float(random.uniform(*served.value)),
            )
    return None
