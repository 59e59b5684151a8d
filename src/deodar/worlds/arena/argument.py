"""Parser of arenas on the command line: the layout and the settings."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any

from deodar.errors import WorldError
from deodar.worlds._settings import named, numeric
from deodar.worlds.arena.arena_settings import ArenaNoise, ArenaPhysics

WORDS = ("unit", "contact", "vehicle")
PLACES = {"start": (2, 3), "goal": (2, 2)}
"""Smallest and largest count of numbers of a place; a start without a heading points along x."""

COUNTS = ("place_every", "camera_every")
NUMBERS = tuple(f.name for part in (ArenaPhysics, ArenaNoise) for f in dc.fields(part) if f.name not in WORDS)


def parse_argument(argument: str) -> tuple[str, Mapping[str, Any]]:
    """Parse `LAYOUT, NAME=VALUE, ...` into a layout and settings.

    An example is `z, unit=cm, goal=-27 78, place_noise=0.5`.

    Raises:
        WorldError: a setting is unknown, or its value is invalid.
    """
    layout, *pieces = (piece.strip() for piece in argument.split(","))
    where = f"arena:{argument}"
    return layout, {
        name: value
        if name in WORDS
        else _place(name, value, argument)
        if name in PLACES
        else numeric(name, value, where, COUNTS)
        for name, value in named(pieces, (*WORDS, *PLACES, *NUMBERS), where).items()
    }


def _place(name: str, value: str, argument: str) -> list[float]:
    least, most = PLACES[name]
    numbers = [_float(word) for word in value.split()]
    if not least <= len(numbers) <= most or None in numbers:
        coordinates = "x and y, and a heading in rad if wanted" if most > least else "x and y"
        raise WorldError(
            f"{name} is {value!r}; expected {coordinates}, with spaces between",
            where=f"arena:{argument}",
            fix=f"For example {name}=20 30",
        )
    return [n for n in numbers if n is not None] + [0.0] * (most - len(numbers))


def _float(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None
