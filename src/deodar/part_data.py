"""Parts as plain data, without their defaults: writing, and reading that lists every problem."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, cast

import numpy as np

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import ParameterError, Problem, UnknownName, did_you_mean
from deodar.parameters import PLAIN, Parameter, Part, an, normal, parameters, show
from deodar.synonyms import synonym

WHOLE = 2.0**53
"""Whole numbers below it are the same in float64 and as an integer."""


def to_data(part: Any, kind: bool = True, without: Sequence[str] = ("name",)) -> JsonObject:
    """Return plain data of a part or an axis: its kind, and every parameter that differs from its default.

    Parameters in `without` are left out: they are stored elsewhere.
    """
    out: dict[str, Any] = {"kind": type(part).__name__} if kind else {}
    for p in parameters(type(part)):
        stored = getattr(part, p.name)
        if p.name not in without and (p.name not in defaults(type(part)) or stored != p.default):
            out[p.name] = _plain(stored, f"{type(part).__name__}.{p.name}", p.of is object)
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
    cls = _kind_of(values.get("kind", kind), where, kinds, problems)
    if cls is None:
        return None
    return part_of(
        cls, {key: value for key, value in values.items() if key != "kind"}, where, preset, problems
    )


def part_of(
    cls: type[Part],
    table: Any,
    where: str,
    preset: Mapping[str, Any],
    problems: list[Problem],
    name: str = "",
) -> Any:
    """Return the part of a known class that plain data describe, or None with its problems added.

    Args:
        cls: its class.
        table: the plain data.
        where: name of its place in messages; "": its parameters are places.
        preset: parameters that are stored elsewhere.
        problems: the list to which problems are added.
        name: name of the class in messages; "": its own.
    """
    name = name or cls.__name__
    if not isinstance(table, dict):
        problems.append(Problem(where, f"needs an object, not {show(table)}"))
        return None
    values = cast("dict[str, Any]", table)
    names = [p.name for p in parameters(cls) if p.name not in preset]
    strange = [key for key in values if key not in names]
    for key in strange:
        row = synonym(cls.__name__, key)
        fix = f"Write: {row.entry(codec.line(values[key]))}" if row else did_you_mean(key, names)
        problems.append(Problem(_inside(where, key), f"{name} has no such parameter", fix))
    missing = [key for key in names if key not in values and key not in defaults(cls)]
    problems += [Problem(where, f"{an(name)} needs {key!r}") for key in missing]
    if strange or missing:
        problems += faulty_values({p.name: p for p in parameters(cls)}, values, where)
        return None
    try:
        return cls(**preset, **values)
    except (ParameterError, UnknownName) as error:
        problems += [
            Problem(_inside(where, p.where.removeprefix(cls.__name__).lstrip(".")), p.what, p.fix)
            for p in error.problems
        ]
        return None


def faulty_values(
    declared: Mapping[str, Parameter], values: Mapping[str, Any], where: str
) -> Iterator[Problem]:
    """Return the other problems of the values that do not depend on the parts that failed."""
    for name, stored in values.items():
        if name in declared and declared[name].form in PLAIN:
            try:
                normal(declared[name], stored)
            except ValueError as error:
                yield Problem(_inside(where, name), str(error))


def _inside(where: str, key: str) -> str:
    return f"{where}.{key}" if where and key else where or key


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


def _plain(stored: Any, where: str, open: bool) -> Any:
    """Return plain data of a value; `open`: of a parameter that is declared for any value.

    Such a number is written in one way, without a decimal point if it is whole: other writers of JSON, such
    as a page, do not distinguish 1.0 from 1.
    """
    if isinstance(stored, (np.ndarray, np.generic)):
        return _plain(stored.tolist(), where, open)
    if isinstance(stored, (list, tuple)):
        return [_plain(v, where, open) for v in cast("list[Any]", stored)]
    if isinstance(stored, Mapping):
        return {str(k): _plain(v, where, open) for k, v in cast("Mapping[Any, Any]", stored).items()}
    if isinstance(stored, float) and open and stored.is_integer() and abs(stored) < WHOLE:
        return int(stored)
    if stored is None or isinstance(stored, (bool, int, float, str)):
        return stored
    raise ParameterError(
        f"{show(stored)} cannot be written in a file",
        where=where,
        fix="Use a number, text, true or false, None, or a list of these",
    )
