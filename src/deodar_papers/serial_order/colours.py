"""Colours of the sequences, by letters, and the sequences."""

from __future__ import annotations

import colorsys
import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.architectures.color_search import HUES
from deodar.errors import ParameterError

FIVE: Mapping[str, float] = {"R": 0.0, "Y": 30.0, "G": 60.0, "B": 120.0, "V": 150.0}
"""Red, yellow, green, blue and violet, in samples of the hue axis (2 degrees each)."""

TEN: Mapping[str, float] = {letter: 18.0 * k for k, letter in enumerate("0123456789")}
"""Ten hues at equal distances."""

VALUE = 0.9
"""Value (largest channel) of the blocks; their saturation is 1."""

PAPER = ("RBGBY", "RGBY", "RGGY", "GYB")
"""The sequences that the paper names (sections 5.3 and 5.4)."""

CLUTTERED = "GYB"
"""The sequence that is learned in clutter."""


def random_sequences() -> tuple[str, ...]:
    """Draw twenty sequences of 2 to 5 of the five colours; a colour may be repeated."""
    rng = np.random.default_rng(7)
    return tuple("".join(rng.choice(list(FIVE), int(rng.integers(2, 6)))) for _ in range(20))


def random_pairs(repeats: bool) -> tuple[tuple[str, str], ...]:
    """Draw fifty pairs of sequences of 3 to 5 of the five colours, which have no colour at the same position.

    Without `repeats` no colour follows itself in a sequence.
    """
    rng = np.random.default_rng(11)
    out: list[tuple[str, str]] = []
    while len(out) < 50:
        first, second = ("".join(rng.choice(list(FIVE), int(rng.integers(3, 6)))) for _ in range(2))
        repeating = any(a == b for s in (first, second) for a, b in itertools.pairwise(s))
        if all(a != b for a, b in zip(first, second, strict=False)) and (repeats or not repeating):
            out.append((first, second))
    return tuple(out)


def rgb(letter: str) -> tuple[float, float, float]:
    """Return red, green and blue of a colour."""
    return colorsys.hsv_to_rgb(hue_of(letter) / HUES, 1.0, VALUE)


def hue_of(letter: str) -> float:
    """Return the sample of hue of a colour."""
    hues = {**FIVE, **TEN}
    if letter not in hues:
        raise ParameterError(f"there is no colour {letter!r}", fix=f"Colours are {', '.join(FIVE)}")
    return hues[letter]


def letter_at(hue: float, among: Sequence[str] = tuple(FIVE)) -> str:
    """Return the colour nearest to a sample of hue."""
    return min(among, key=lambda letter: away(hue, hue_of(letter)))


def offset(hue: float, reference: float) -> float:
    """Return how far a hue lies from another one on their circle, with its sign, in samples."""
    return (hue - reference + HUES / 2) % HUES - HUES / 2


def away(hue: float, reference: float) -> float:
    """Return the distance of two hues on their circle, in samples."""
    return abs(offset(hue, reference))
