"""Parts as plain data, without their defaults: writing, and reading that lists every problem."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from deodar.codec import JsonObject
from deodar.errors import ParameterError, Problem, UnknownName, did_you_mean
from deodar.parameters import Part, an, parameters, show

WHOLE = 2.0**53
"""Whole numbers below it are the same in float64 and as an integer."""


def to_data(part: Part, kind: bool = True, without: Sequence[str] = ("name",)) -> JsonObject:
    """Return plain data of a part: its kind, and every parameter that differs from its default.

    Parameters in `without` are left out: they are stored elsewhere.
    """
    out: dict[str, Any] = {"kind": type(part).__name__} if kind else {}
    for p in parameters(type(part)):
        value = getattr(part, p.name)
        if (
            p.name not in without
            and value is not None
            and (p.name not in defaults(type(part)) or value != p.default)
        ):
            out[p.name] = _plain(value, f"{type(part).__name__}.{p.name}", p.of is object)
    return out


def from_data(
    data: Any,
    where: str,
    kinds: Mapping[str, type[Part]],
    preset: Mapping[str, Any],
    problems: list[Problem],
    kind: str = "",
) -> Any:
    """Return the part that plain data describe, or None with its problems added to `problems`.

    Args:
        data: the plain data.
        where: name of its place in messages.
        kinds: the valid kinds.
        preset: parameters that are stored elsewhere.
        problems: the list to which problems are added.
        kind: default kind, where the data need not state it.
    """
    if not isinstance(data, dict):
        problems.append(Problem(where, f"needs an object, not {show(data)}"))
        return None
    values = cast("dict[str, Any]", data)
    name = values.get("kind", kind)
    cls = _kind_of(name, where, kinds, problems)
    if cls is None:
        return None
    names = [p.name for p in parameters(cls) if p.name not in preset]
    strange = [key for key in values if key != "kind" and key not in names]
    problems += [
        Problem(f"{where}.{key}", f"{name} has no such parameter", did_you_mean(key, names))
        for key in strange
    ]
    missing = [
        p.name
        for p in parameters(cls)
        if p.name in names and p.name not in values and p.name not in defaults(cls)
    ]
    problems += [Problem(where, f"{an(name)} needs {key!r}") for key in missing]
    if strange or missing:
        return None
    try:
        return cls(**preset, **{key: value for key, value in values.items() if key != "kind"})
    except (ParameterError, UnknownName) as error:
        problems += [
            Problem(f"{where}{p.where.removeprefix(cls.__name__)}", p.what, p.fix) for p in error.problems
        ]
        return None


def _kind_of(
    name: Any, where: str, kinds: Mapping[str, type[Part]], problems: list[Problem]
) -> type[Part] | None:
    """Return the kind of a name, or None with its problems added."""
    if not isinstance(name, str) or name not in kinds:
        problem = f"there is no {show(name)} here" if name else "has no kind"
        problems.append(Problem(f"{where}.kind", problem, did_you_mean(str(name), kinds)))
        return None
    try:
        return kinds[name]
    except UnknownName as error:  # from a package that cannot be used
        problems += [Problem(f"{where}.kind", p.what, p.fix) for p in error.problems]
        return None


def defaults(cls: type[Part]) -> set[str]:
    """Return the names of parameters that need not be given."""
    return {
        f.name
        for f in dc.fields(cast(Any, cls))
        if f.default is not dc.MISSING or f.default_factory is not dc.MISSING
    }


def _plain(value: Any, where: str, open: bool) -> Any:
    """Return plain data of a value; `open`: of a parameter that is declared for any value.

    Such a number is written in one way, without a decimal point if it is whole: other writers of JSON, such
    as a page, do not distinguish 1.0 from 1.
    """
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist(), where, open)
    if isinstance(value, (list, tuple)):
        return [_plain(v, where, open) for v in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        return {str(k): _plain(v, where, open) for k, v in cast("Mapping[Any, Any]", value).items()}
    if isinstance(value, float) and open and value.is_integer() and abs(value) < WHOLE:
        return int(value)
    if isinstance(value, (bool, int, float, str)):
        return value
    raise ParameterError(
        f"{show(value)} cannot be written in a file",
        where=where,
        fix="Use a number, text, true or false, or a list of these",
    )
