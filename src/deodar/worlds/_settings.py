"""Checks of the settings of worlds, and settings in an argument of the command line."""

from __future__ import annotations

import dataclasses as dc
import inspect
import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import real, show


def periods(name: str, given: Any) -> int:
    """Return a whole number of periods, or raise WorldError."""
    if isinstance(given, bool) or not isinstance(given, (int, np.integer)) or given < 1:
        raise WorldError(f"{name} is {show(given)}; expected a whole number of periods, at least 1")
    return int(given)


def number(name: str, given: Any, above: float | None = None) -> float:
    """Return a finite number of 0 or more, or above a value, or raise WorldError."""
    value = real(given)
    if value is None or not math.isfinite(value) or value < 0 or (above is not None and value <= above):
        raise WorldError(
            f"{name} is {show(given)}; expected a finite number,"
            f" {'above 0' if above is not None else '0 or above'}"
        )
    return float(value)


def finite_rows(name: str, given: Any, size: int) -> np.ndarray:
    """Return rows of `size` finite numbers, from one row or a row for each trial, or raise WorldError."""
    try:
        found = np.atleast_2d(np.asarray(given, float))
    except (TypeError, ValueError):
        found = np.zeros((0, 0))
    if found.ndim != 2 or found.shape[1] != size or not len(found) or not np.isfinite(found).all():
        raise WorldError(
            f"is {show(given)}; expected {size} finite numbers, or a row of them for each trial", where=name
        )
    return found


def named(pieces: Sequence[str], names: Collection[str], where: str) -> dict[str, str]:
    """Return the values of `NAME=VALUE` pieces of an argument by name, or raise WorldError.

    Args:
        pieces: the pieces.
        names: all settings.
        where: the argument, for messages.
    """
    found: dict[str, str] = {}
    for piece in pieces:
        name, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or name not in names:
            what = repr(name if equal else piece)
            raise WorldError(f"there is no setting {what}", where=where, fix=did_you_mean(name, names))
        found[name] = value
    return found


def numeric(name: str, value: str, where: str, counts: Collection[str] = ()) -> float | int:
    """Return the number that a value of an argument states, or raise WorldError.

    A whole number is an int if the setting is one of `counts`.
    """
    try:
        given = float(value)
    except ValueError:
        raise WorldError(f"{name} is {value!r}; expected a number", where=where) from None
    return int(given) if name in counts and given.is_integer() else given


def groups(cls: type) -> dict[str, Any]:
    """Return the dataclasses among the arguments of a world's constructor, with their defaults."""
    found = inspect.signature(cls.__init__).parameters.values()
    return {p.name: p.default for p in found if dc.is_dataclass(p.default)}


def setting_names(cls: type) -> list[str]:
    """Return the names of the settings of a world: its arguments, of a dataclass among them the fields."""
    found, known = inspect.signature(cls.__init__).parameters, groups(cls)
    names = [[f.name for f in dc.fields(known[name])] if name in known else [name] for name in found]
    return [name for each in names for name in each if name not in ("self", "args", "kwargs")]


def arguments(cls: type, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a world's constructor for settings by name; those of a dataclass make one."""
    found = dict(settings)
    for name, default in groups(cls).items():
        own = {f.name: found.pop(f.name) for f in dc.fields(default) if f.name in found}
        if own:
            found[name] = dc.replace(default, **own)
    return found


def of(trials: Sequence[int], rows: np.ndarray, what: str) -> np.ndarray:
    """Return the row of each trial; a single row is used for all trials."""
    if len(rows) == 1:
        return np.repeat(rows, len(trials), axis=0)
    if max(trials) >= len(rows):
        text = f"there are {len(rows)} of them, and trial {max(trials)} is run"
        raise WorldError(text, where=what, fix="Give one for all, or a row for each trial")
    return rows[list(trials)]
