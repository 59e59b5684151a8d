"""Parts of an experiment as JSON: their schema, out, and in again with every problem listed."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from deodar.errors import ParameterError, Problem, UnknownName, did_you_mean
from deodar.model.parts import schema as schema_of
from deodar.parameters import Part, an, parameters, show


def to_data(part: Part, kind: bool = True, without: Sequence[str] = ("name",)) -> dict[str, Any]:
    """Plain data of a part: its kind, and every parameter that is not what it is by default, `without` those
    that stand elsewhere.
    """
    out: dict[str, Any] = {"kind": type(part).__name__} if kind else {}
    for p in parameters(type(part)):
        value = getattr(part, p.name)
        if (
            p.name not in without
            and value is not None
            and (p.name not in _defaults(type(part)) or value != p.default)
        ):
            out[p.name] = _plain(value, f"{type(part).__name__}.{p.name}")
    return out


def from_data(
    data: Any,
    where: str,
    kinds: Mapping[str, type[Part]],
    given: Mapping[str, Any],
    problems: list[Problem],
    kind: str = "",
) -> Any:
    """The part that plain data describe, or None with what is wrong added to `problems`.

    Args:
        data: the plain data.
        where: how messages call its place.
        kinds: what it may be.
        given: parameters that stand elsewhere.
        problems: what is wrong.
        kind: what it is, where the data need not say.
    """
    if not isinstance(data, dict):
        problems.append(Problem(where, f"needs an object, not {show(data)}"))
        return None
    values = cast("dict[str, Any]", data)
    name = values.get("kind", kind)
    if not isinstance(name, str) or name not in kinds:
        what = f"there is no {show(name)} here" if name else "has no kind"
        problems.append(Problem(f"{where}.kind", what, did_you_mean(str(name), kinds)))
        return None
    try:
        cls = kinds[name]
    except UnknownName as error:  # of a package that cannot be used
        problems += [Problem(f"{where}.kind", p.what, p.fix) for p in error.problems]
        return None
    known = [p.name for p in parameters(cls) if p.name not in given]
    strange = [key for key in values if key != "kind" and key not in known]
    problems += [
        Problem(f"{where}.{key}", f"{name} has no such parameter", did_you_mean(key, known))
        for key in strange
    ]
    missing = [
        p.name
        for p in parameters(cls)
        if p.name in known and p.name not in values and p.name not in _defaults(cls)
    ]
    problems += [Problem(where, f"{an(name)} needs {key!r}") for key in missing]
    if strange or missing:
        return None
    try:
        return cls(**given, **{key: value for key, value in values.items() if key != "kind"})
    except (ParameterError, UnknownName) as error:
        problems += [Problem(f"{where}{p.where.removeprefix(name)}", p.what, p.fix) for p in error.problems]
        return None


def schema(kinds: Mapping[str, type[Part]], named: bool) -> dict[str, Any]:
    """JSON Schema of any of some kinds; `named`: their name stands beside them."""
    out: list[dict[str, Any]] = []
    for cls in kinds.values():
        found = schema_of(cls, lambda base: {})
        for p in parameters(cls):
            if p.of is object:  # whatever the parameter takes that it is for
                found["properties"][p.name] = {"description": p.meaning}
        found["required"] = [
            "kind",
            *(
                p.name
                for p in parameters(cls)
                if p.name not in _defaults(cls) and (p.name != "name" or not named)
            ),
        ]
        out.append(found | {"additionalProperties": False})
    return {"oneOf": out}


def _defaults(cls: type[Part]) -> set[str]:
    """Parameters that need not be given."""
    return {
        f.name
        for f in dc.fields(cast(Any, cls))
        if f.default is not dc.MISSING or f.default_factory is not dc.MISSING
    }


def _plain(value: Any, where: str) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(v, where) for v in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        return {str(k): _plain(v, where) for k, v in cast("Mapping[Any, Any]", value).items()}
    if isinstance(value, (bool, int, float, str)):
        return value
    raise ParameterError(
        f"{show(value)} cannot be written in a file",
        where=where,
        fix="Take a number, text, true or false, or a list of these",
    )
