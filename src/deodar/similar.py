"""The known name that a misspelt one is probably meant to be."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Sequence

SLIPS = ((2, 0), (7, 1), (11, 2))
"""Most slips of a word by its length: none up to two letters, one up to seven, two up to eleven."""

MOST_SLIPS = 3
"""Most slips of a longer word."""

LONGEST = 200
"""Most letters of a name that is compared with others; a longer one is similar to none."""


def nearest(name: str, names: Iterable[str]) -> str:
    """Return the known name that differs from a name by slips of typing alone; "" if there is none.

    A slip is a letter that is added, left out, replaced, or exchanged with the next one. Case, hyphens,
    underscores and spaces do not count. Each word between dots has slips of its own, so that neither the
    ending of a file nor the port of a path makes two names similar. Of equally near names the last one by
    the alphabet is returned: of versions the latest.

    >>> nearest("restng_level", ["tau", "resting_level"]), nearest("heading", ["bearing"])
    ('resting_level', '')
    """
    best, fewest = "", math.inf
    if len(name) > LONGEST:
        return best
    count = functools.cache(_word_slips)  # names of one document repeat their words
    for candidate in sorted({word for word in names if len(word) <= LONGEST}, reverse=True):
        slips = _distance(name, candidate, count)
        if slips is not None and slips < fewest:
            best, fewest = candidate, slips
    return best


def _distance(name: str, candidate: str, count: Callable[[str, str], int | None]) -> int | None:
    """Return the number of slips between two names; None if they are more than a word may have."""
    words, targets = _words(name), _words(candidate)
    if len(words) != len(targets):
        words, targets = ["".join(words)], ["".join(targets)]
    total = 0
    for word, target in zip(words, targets, strict=True):
        slips = count(word, target)
        if slips is None:
            return None
        total += slips
    return total


def _word_slips(word: str, target: str) -> int | None:
    """Return the number of slips between two words; None if they are more than a word may have."""
    longest = max(len(word), len(target))
    most = next((slips for length, slips in SLIPS if longest <= length), MOST_SLIPS)
    if longest > SLIPS[0][0] + 1 and sorted(word) == sorted(target):  # the same letters in any order
        return _slips(word, target, longest)
    slips = _slips(word, target, most)
    return slips if slips <= most else None


def _words(name: str) -> list[str]:
    plain = name.casefold().translate(dict.fromkeys(map(ord, "_- ")))
    return [word for word in plain.split(".") if word]


def _slips(a: Sequence[str], b: Sequence[str], most: int) -> int:
    """Return the optimal string alignment distance, or a larger number than `most` where it is larger.

    Cells that lie further from the diagonal than `most` stay above it and are not visited.
    """
    if abs(len(a) - len(b)) > most:
        return most + 1
    before, last = list[int](), list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        row = [i] + [most + 1] * len(b)
        for j in range(max(1, i - most), min(len(b), i + most) + 1):
            y = b[j - 1]
            cost = min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (x != y))
            if i > 1 and j > 1 and (x, a[i - 2]) == (b[j - 2], y):
                cost = min(cost, before[j - 2] + 1)
            row[j] = cost
        if min(*row, *last) > most:
            return most + 1
        before, last = last, row
    return last[-1]
