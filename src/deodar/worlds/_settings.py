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


def periods(name: str, count: Any) -> int:
    """Return a whole number of periods, or raise WorldError."""
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
        raise WorldError(f"{name} is {show(count)}; expected a whole number of periods, at least 1")
    return int(count)


def number(name: str, given: Any, above: float | None = None) -> float:
    """Return a finite number of 0 or more, or above a value, or raise WorldError."""
    parsed = real(given)
    if parsed is None or not math.isfinite(parsed) or parsed < 0 or (above is not None and parsed <= above):
        raise WorldError(
            f"{name} is {show(given)}; expected a finite number,"
            f" {'above 0' if above is not None else '0 or above'}"
        )
    return float(parsed)


def finite_rows(name: str, given: Any, size: int) -> np.ndarray:
    """Return rows of `size` finite numbers, from one row or a row for each trial, or raise WorldError."""
    try:
        matrix = np.atleast_2d(np.asarray(given, float))
    except (TypeError, ValueError):
        matrix = np.zeros((0, 0))
    if matrix.ndim != 2 or matrix.shape[1] != size or not len(matrix) or not np.isfinite(matrix).all():
        raise WorldError(
            f"is {show(given)}; expected {size} finite numbers, or a row of them for each trial", where=name
        )
    return matrix


def named(pieces: Sequence[str], names: Collection[str], where: str) -> dict[str, str]:
    """Return the values of `NAME=VALUE` pieces of an argument by name, or raise WorldError.

    Args:
        pieces: the pieces.
        names: all settings.
        where: the argument, for messages.
    """
    settings: dict[str, str] = {}
    for piece in pieces:
        name, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or name not in names:
            setting = repr(name if equal else piece)
            raise WorldError(f"there is no setting {setting}", where=where, fix=did_you_mean(name, names))
        settings[name] = value
    return settings


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
    parameters = inspect.signature(cls.__init__).parameters.values()
    return {p.name: p.default for p in parameters if dc.is_dataclass(p.default)}


def setting_names(cls: type) -> list[str]:
    """Return the names of the settings of a world: its arguments, of a dataclass among them the fields."""
    parameters, nested = inspect.signature(cls.__init__).parameters, groups(cls)
    names = [[f.name for f in dc.fields(nested[name])] if name in nested else [name] for name in parameters]
    return [name for field_names in names for name in field_names if name not in ("self", "args", "kwargs")]


def arguments(cls: type, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a world's constructor for settings by name; those of a dataclass make one."""
    by_name = dict(settings)
    for name, default in groups(cls).items():
        fields = {f.name: by_name.pop(f.name) for f in dc.fields(default) if f.name in by_name}
        if fields:
            by_name[name] = dc.replace(default, **fields)
    return by_name


def of(trials: Sequence[int], rows: np.ndarray, label: str) -> np.ndarray:
    """Return the row of each trial; a single row is used for all trials."""
    if len(rows) == 1:
        return np.repeat(rows, len(trials), axis=0)
    if max(trials) >= len(rows):
        text = f"there are {len(rows)} of them, and trial {max(trials)} is run"
        raise WorldError(text, where=label, fix="Give one for all, or a row for each trial")
    return rows[list(trials)]
