"""Parts as JSON: their schema, writing, and reading that lists every problem."""

from __future__ import annotations

import dataclasses as dc
import typing
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from deodar import codec, registry
from deodar.declarations import Needed
from deodar.errors import Fix, ParameterError, Problem, UnknownName, did_you_mean
from deodar.leaves import get, parameter_values
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, Parameter, Part, an, parameter, parameters, show
from deodar.part_data import faulty_values
from deodar.synonyms import synonym

MOST_AXES = 64
"""Largest number of axes of one part, the most that an array has."""


def schema(cls: type[Any], reference: Callable[[type[Any]], Any]) -> dict[str, Any]:
    """Return the JSON Schema of a part; `reference(base)` returns the schema of the parts that are valid as
    `base`.
    """
    properties: dict[str, Any] = {"kind": {"const": cls.__name__}}
    for p in parameters(cls):
        if p.name == "name":
            continue
        form: dict[str, Any] = form_schema(p, reference)
        if p.optional:
            form = {"oneOf": [form, {"type": "null"}]}
        for key, value in (("minimum", p.lower), ("maximum", p.upper)):
            if value is not None and form.get("type") == "number":
                form[key] = value
        extra: dict[str, Any] = {"x-cost": p.cost}
        for key, value in (("x-unit", p.unit), ("description", p.meaning)):
            if value:
                extra[key] = value
        if isinstance(p.default, (bool, int, float, str)):
            extra["default"] = p.default
        properties[p.name] = form | extra
    return {
        "type": "object",
        "title": cls.__name__,
        "properties": properties,
        "required": ["kind", *(p.name for p in parameters(cls) if isinstance(p.default, Needed))],
    }


def form_schema(p: Parameter, reference: Callable[[type[Any]], Any]) -> dict[str, Any]:
    """Return the JSON Schema of the values of a parameter, without its range."""
    number: dict[str, Any] = {"type": "number"}
    match p.form:
        case "number":
            return dict(number)
        case "per_axis":
            return {"oneOf": [number, {"type": "array", "items": number}]}
        case "integer":
            return {"type": "integer"}
        case "flag":
            return {"type": "boolean"}
        case "text":
            return {"enum": list(p.choices)} if p.choices else {"type": "string"}
        case "texts":
            return {"type": "array", "items": {"type": "string"}}
        case "axes":
            return {
                "type": "array",
                "items": {"type": "string"},
                "description": "keys of the document's axes",
            }
        case "axis":
            return {"type": "string", "description": "key of one of the document's axes"}
        case "part":
            return reference(typing.cast(Any, p.of))
        case "parts":
            return {"type": "array", "items": reference(typing.cast(Any, p.of))}
        case "array":
            return {"type": "object", "properties": {"array": {"type": "string"}}, "required": ["array"]}
        case "numbers":
            return {"type": "object", "additionalProperties": number}
        case "pairs":
            return {"type": "object", "additionalProperties": {"type": "string"}}
        case "value":
            return {"description": "any value"}


def to_json(
    part: Any, axis_key: Callable[[Any], str], array_key: Callable[[FrozenArray], str]
) -> dict[str, Any]:
    """Return a part as plain data: its kind and every parameter, in the order of the fields."""
    out: dict[str, Any] = {"kind": type(part).__name__}
    for p in parameters(type(part)):
        if p.name != "name":
            value = getattr(part, p.name)
            out[p.name] = None if value is None else _plain(p, value, axis_key, array_key)
    return out


def axes_in(part: Part) -> Iterator[Axis]:
    """Yield the axes of a part and of the parts inside it, in the order of the fields."""
    for p, value in parameter_values(part):
        if p.form == "axes":
            yield from value
        elif p.form == "axis":
            yield value


def _plain(
    p: Parameter, value: Any, axis_key: Callable[[Any], str], array_key: Callable[[FrozenArray], str]
) -> Any:
    match p.form:
        case "axes":
            return [axis_key(a) for a in value]
        case "axis":
            return axis_key(value)
        case "part":
            return to_json(value, axis_key, array_key)
        case "parts":
            return [to_json(v, axis_key, array_key) for v in value]
        case "array":
            return {"array": array_key(value)}
        case "numbers" | "pairs":
            return dict(value)
        case _:
            return list(typing.cast(Any, value)) if isinstance(value, tuple) else value


def _from_json(
    data: Any,
    where: str,
    axes: Mapping[str, Any],
    arrays: Mapping[str, FrozenArray],
    base: type[Any],
    problems: list[Problem],
    given: dict[str, Any],
) -> Any:
    cls = _kind_of(data, where, base, problems)
    if cls is None:
        return None
    declared = {p.name: p for p in parameters(cls)}
    values: dict[str, Any] = dict(given)
    faults: list[Problem] = []
    for name, value in data.items():
        if name in ("kind", *given):
            continue
        if name not in declared:
            row = synonym(cls.__name__, name)
            fix = f"Write: {row.entry(codec.line(value))}" if row else did_you_mean(name, declared)
            faults.append(Problem(f"{where}.{name}", f"{cls.__name__} has no such parameter", fix))
            continue
        before = len(faults)
        read = _value(declared[name], value, f"{where}.{name}", axes, arrays, faults)
        if read is not None or value is None or len(faults) == before:
            values[name] = read
    stated = [q.where.rpartition(".")[2] for q in faults]
    for p in declared.values():
        if isinstance(p.default, Needed) and values.get(p.name) is None and p.name not in stated:
            faults.append(
                Problem(f"{where}.{p.name}", f"{cls.__name__} needs {p.name}", _to_write(p, p.default, axes))
            )
    if faults:
        problems += [*faults, *faulty_values(declared, values, where)]
        return None
    try:
        return cls(**values)
    except (ParameterError, UnknownName) as error:
        problems += [Problem(_under(where, cls, q.where), q.what, q.fix) for q in error.problems]
    except TypeError as error:
        problems.append(Problem(where, str(error)))
    return None


def _kind_of(data: Any, where: str, base: type[Any], problems: list[Problem]) -> type[Any] | None:
    """Return the class that data name; None with a problem if they name none of a base."""
    if not isinstance(data, dict) or not isinstance(typing.cast(Any, data).get("kind"), str):
        problems.append(Problem(where, f"needs an object with a kind, not {show(data)}"))
        return None
    try:
        cls = registry.kind(typing.cast("dict[str, Any]", data)["kind"])
    except UnknownName as error:
        first = "For a kind of your own, import its module first"
        hint = Fix(first, f"{first}: deodar --import MODULE ...")
        problems.append(Problem(where, error.problems[0].what, Fix(error.problems[0].fix).then(hint)))
        return None
    if not issubclass(cls, base):
        problems.append(Problem(where, f"expected {an(base.__name__)}, got {an(cls.__name__)}"))
        return None
    return cls


def _value(
    p: Parameter,
    value: Any,
    where: str,
    axes: Mapping[str, Any],
    arrays: Mapping[str, FrozenArray],
    problems: list[Problem],
) -> Any:
    """Return the value of one parameter; None with a problem if it cannot be read."""
    match p.form:
        case _ if value is None:
            return None
        case "axes" | "axis":
            keys = value if p.form == "axes" else [value]
            if not isinstance(keys, list) or any(
                not isinstance(k, str) or k not in axes for k in typing.cast("list[Any]", keys)
            ):
                problems.append(
                    Problem(
                        where,
                        f"{show(value)} is not among the document's axes",
                        f"Axes of the document: {', '.join(axes) or 'none'}",
                    )
                )
                return None
            if len(keys) > MOST_AXES:
                problems.append(Problem(where, f"{len(keys):,} axes, more than {MOST_AXES}"))
                return None
            listed = [axes[k] for k in typing.cast("list[str]", keys)]
            return listed if p.form == "axes" else listed[0]
        case "part":
            return _from_json(value, where, axes, arrays, typing.cast(Any, p.of), problems, {})
        case "parts":
            if not isinstance(value, list):
                problems.append(Problem(where, f"needs a list, not {show(value)}"))
                return None
            items = typing.cast("list[Any]", value)
            return [
                _from_json(v, f"{where}.{i}", axes, arrays, typing.cast(Any, p.of), problems, {})
                for i, v in enumerate(items)
            ]
        case "array":
            key = typing.cast(Any, value).get("array") if isinstance(value, dict) else None
            if not isinstance(key, str) or key not in arrays:
                problems.append(Problem(where, f"the array {key!r} is not in the document's array file"))
                return None
            return arrays[key]
        case _:
            return value


def _to_write(p: Parameter, needed: Needed, axes: Mapping[str, Any]) -> str:
    """Return the line of a document that gives a parameter its axes.

    A letter means any axis of the document, a word an axis of this name.
    """
    free = [key for key in axes if key not in needed.names]
    keys = [free.pop(0) if len(name) == 1 and name not in axes and free else name for name in needed.names]
    undeclared = [key for key in keys if key not in axes]
    line = f'Write "{p.name}": {codec.line(keys if p.form == "axes" else keys[0])}'
    if undeclared:
        return (
            f'{line}, and declare among the document\'s axes: "{undeclared[0]}": {{"lower": 0, "upper": 100,'
            ' "samples": 101}'
        )
    return f"{line}; the document's axes are: {', '.join(axes)}" if len(axes) > len(keys) else line


def _under(where: str, cls: type[Any], inner: str) -> str:
    path = inner.removeprefix(cls.__name__)
    return f"{where}{path}" if path.startswith(".") else where


def part_from_json(
    data: Any,
    where: str,
    axes: Mapping[str, Any],
    arrays: Mapping[str, FrozenArray],
    base: type[Any],
    name: str,
    given: Mapping[str, Any] | None = None,
) -> Any:
    """Return the named part that plain data describe; the error lists every problem with its path.

    `given` are further values, not as plain data.
    """
    problems: list[Problem] = []
    part = _from_json(data, where, axes, arrays, base, problems, {**(given or {}), "name": name})
    if problems:
        raise ParameterError(problems)
    return part


def value_from_json(
    part: Any, path: str, data: Any, where: str, axes: Mapping[str, Any], arrays: Mapping[str, FrozenArray]
) -> Any:
    """Return the value that plain data describe for one parameter of a part, not yet checked against it.

    The path is of the form `tau`, `kernel`, `kernel.0` or `kernel.0.sigma`.
    """
    p, whole = _declared(part, path)
    if p.form == "parts" and not whole:
        p = dc.replace(p, form="part")
    elif not whole or (p.form == "array" and not isinstance(data, dict)):
        return data  # a number inside a value, or an array given by its numbers
    problems: list[Problem] = []
    value = _value(p, data, where, axes, arrays, problems)
    if problems:
        raise ParameterError(problems)
    return value


def _declared(part: Any, path: str) -> tuple[Parameter, bool]:
    """Return the declaration at the end of a path, and whether it means the whole value, not an item."""
    *before, last = path.split(".")
    holder, p = part, None
    for step in before:
        p = parameter(type(holder), step) if isinstance(holder, Part) else p
        holder = get(holder, step)
    if isinstance(holder, Part):
        return parameter(type(holder), last), True
    assert p is not None  # the whole is a part
    return p, False


def kinds_in(data: Any) -> Iterator[str]:
    """Yield the kinds of all parts in plain data, at every depth."""
    if isinstance(data, Mapping):
        body = typing.cast("Mapping[str, Any]", data)
        if isinstance(body.get("kind"), str):
            yield body["kind"]
        for value in body.values():
            yield from kinds_in(value)
    elif isinstance(data, list):
        for value in typing.cast("list[Any]", data):
            yield from kinds_in(value)


def foreign_kinds(document: Mapping[str, Any]) -> list[type[Any]]:
    """Return the classes outside deodar that the plain data of a document name."""
    used = {name: registry.kind(name) for name in kinds_in(document["elements"])}
    return [cls for _, cls in sorted(used.items()) if not registry.own(cls)]
