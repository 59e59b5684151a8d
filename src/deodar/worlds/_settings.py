"""Checks of the settings of worlds, and settings in an argument of the command line."""

from __future__ import annotations

import dataclasses as dc
import inspect
import math
import os
from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any, Literal

import numpy as np

from deodar.declarations import Recompile
from deodar.errors import WorldError, did_you_mean
from deodar.parameters import normal, parameters, real, show

SettingForm = Literal["text", "number", "flag", "numbers"]
FLAGS = {"yes": True, "true": True, "no": False, "false": False}


PositiveNumber = Annotated[float, Recompile(lower=1e-6)]
From0 = Annotated[float, Recompile(lower=0.0)]
Share = Annotated[float, Recompile(lower=0.0, upper=1.0)]
PeriodCount = Annotated[int, Recompile(lower=1)]


@dc.dataclass(frozen=True)
class WorldSettings:
    """The base class of groups of settings: frozen dataclasses, whose values are checked as they declare."""

    def __post_init__(self) -> None:
        for p in parameters(type(self)):
            try:
                object.__setattr__(self, p.name, normal(p, getattr(self, p.name)))
            except ValueError as error:
                raise WorldError(f"{p.name} {error}") from None


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


def groups(cls: type) -> dict[str, Any]:
    """Return the dataclasses among the arguments of a world's constructor, with their defaults."""
    parameters = inspect.signature(cls).parameters.values()
    return {p.name: p.default for p in parameters if dc.is_dataclass(p.default)}


def settings(cls: type) -> dict[str, tuple[Any, str]]:
    """Return default and annotation of each setting of a world: its arguments, of a dataclass the fields."""
    declared, nested = dict[str, tuple[Any, str]](), groups(cls)
    for name, p in inspect.signature(cls).parameters.items():
        if name in nested:
            group = nested[name]
            declared |= {f.name: (getattr(group, f.name), str(f.type)) for f in dc.fields(group)}
        elif p.kind is p.POSITIONAL_OR_KEYWORD:
            declared[name] = p.default, str(p.annotation)
    return declared


def form_of(default: Any, annotation: str) -> SettingForm | None:
    """Return the form of a setting; None for one whose values are other objects."""
    if isinstance(default, bool):
        return "flag"
    if isinstance(default, (int, float)) or annotation.startswith("float"):
        return "number"
    if isinstance(default, str) or annotation.startswith("str"):
        return "text"
    return "numbers" if annotation.startswith("Sequence[float]") else None


def parse_argument(cls: type, argument: str, closed: Collection[str] = ()) -> tuple[str, dict[str, Any]]:
    """Parse `FIRST, NAME=VALUE, ...` into its first part and arguments of a world's constructor.

    An example is `z, unit=cm, goal=-27 78, place_noise=0.5`. A comma in the name of an existing file is part
    of the name.

    Args:
        cls: the class of the world.
        argument: the argument, as on the command line.
        closed: settings that an argument may not state, besides the first.

    Raises:
        WorldError: a setting is unknown, or its value is invalid.
    """
    first, given, where = argument.strip(), dict[str, Any](), f"{cls.__name__.lower()}:{argument}"
    known = settings(cls)
    names = [name for name in list(known)[1:] if name not in closed and form_of(*known[name])]
    while "," in first and not os.path.exists(first):
        first, _, piece = (part.strip() for part in first.rpartition(","))
        name, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or name not in names:
            raise WorldError(f"there is no setting {name!r}", where=where, fix=did_you_mean(name, names))
        given[name] = _value(name, value, *known[name], where)
    return first, arguments(cls, given)


def _value(name: str, text: str, default: Any, annotation: str, where: str) -> Any:
    form = form_of(default, annotation)
    try:
        if form == "flag":
            return FLAGS[text.lower()]
        if form == "numbers":
            return [float(word) for word in text.replace("x", " ").split()]
        if form == "number":
            number = float(text)
            return int(number) if isinstance(default, int) and number.is_integer() else number
    except (KeyError, ValueError):
        expected = {"flag": "yes or no", "numbers": "numbers with spaces between"}.get(str(form), "a number")
        raise WorldError(f"{name} is {text!r}; expected {expected}", where=where) from None
    return text


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
