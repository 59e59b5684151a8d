"""Everything registered, as the page knows it: from declarations and docstrings alone."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Sequence
from typing import Any

from deodar import registry
from deodar.declarations import Needed
from deodar.element import Element
from deodar.model.parts import to_json
from deodar.parameters import FrozenArray, Parameter, Part, parameters, positional
from deodar.server.docstring import Docstring, docstring
from deodar.server.symbols import NAME, is_letter, symbol
from deodar.server.to_page import Kind, ParameterForm
from deodar.worlds._base import World

QUANTITIES = ("number", "integer", "per_axis", "part", "array", "numbers")
"""Forms of parameters whose names may stand in an equation."""


def kinds() -> list[Kind]:
    """Every registered kind, also those of modules from outside that have been imported."""
    known = registry.kinds()
    return [_kind(cls, known) for cls in known.values()]


def title(name: str) -> str:
    """The name of a class in words: Gaussian stimulus."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|_+", " ", name).split()
    lower = [w if w.isupper() and len(w) > 1 else w.lower() for w in words]
    return " ".join(w if i or w.isupper() else w.capitalize() for i, w in enumerate(lower))


def _kind(cls: type[Any], known: dict[str, type[Any]]) -> Kind:
    says = docstring(cls)
    example = _example(cls)
    declared = _declared(cls) if issubclass(cls, Part) else []
    return Kind(
        name=cls.__name__,
        room=_room(cls),
        title=title(cls.__name__),
        equation=list(says.equation),
        reference=says.reference,
        parameters=[_form(p, says, known) for p in declared],
        ports=_ports(cls, says, example),
        levels={port: dict(levels) for port, levels in getattr(cls, "levels", {}).items()},
        example=_json(example) if isinstance(example, Part) and not isinstance(example, Element) else None,
    )


def _declared(cls: type[Part]) -> list[Parameter]:
    """Parameters as they are written down: those by position, then those by name; `name` is every
    element's.
    """
    first = positional(cls)
    return sorted((p for p in parameters(cls) if p.name != "name"), key=lambda p: p.name not in first)


def _room(cls: type[Any]) -> str:
    """The last part of the folder it stands in; windows, which are no folder, stand for themselves."""
    package, *inner = cls.__module__.split(".")
    if package != "deodar":
        return "worlds" if issubclass(cls, World) else "own"
    return inner[1] if inner[0] == "numerics" else inner[0]


def _example(cls: type[Any]) -> Any:
    """An instance that works on its own; None where code from outside gives none."""
    try:
        return cls.example() if issubclass(cls, Part) else None
    except Exception:  # a kind from outside may need values that it does not give
        return None


def _ports(cls: type[Any], says: Docstring, example: Any) -> dict[str, str]:
    """Ports and what they carry, those that the docstring leaves out without words; of a world its sensors
    and motors.
    """
    if issubclass(cls, World):
        return {name: str(signal) for name, signal in {**cls.sensors, **cls.motors}.items()}
    if not issubclass(cls, Element):
        return {}
    inputs, outputs = list(cls.inputs), list[str]()
    if isinstance(example, Element):
        inputs = list(example.ports())
        try:
            outputs = list(example.outputs({port: example.wants(port, ()) or () for port in inputs}))
        except Exception:  # the same
            outputs = []
    return {**says.ports, **{port: says.ports.get(port, "") for port in [*inputs, *outputs]}}


# ------------------------------------------------------------------------------------------------- parameters


def _form(p: Parameter, says: Docstring, known: dict[str, type[Any]]) -> ParameterForm:
    description = says.parameters.get(p.name, "")
    return ParameterForm(
        name=p.name,
        form=p.form,
        cost=p.cost,
        meaning=p.meaning,
        description=description,
        symbol=_symbol(p, description, says.equation),
        unit=p.unit,
        lower=p.lower,
        upper=p.upper,
        default=_plain(p, p.default),
        optional=p.optional,
        choices=list(p.choices),
        of=[
            name
            for name, cls in known.items()
            if p.of is not None and p.form in ("part", "parts") and issubclass(cls, p.of)
        ],
    )


def _symbol(p: Parameter, description: str, equation: Sequence[str]) -> str:
    """The symbol that its description begins with (`h, the attractor`), else its own name where the equation
    has it.
    """
    first = NAME.match(description)
    if first and is_letter(first[0]) and description[first.end() : first.end() + 1] in (",", ".", ":", ";"):
        return symbol(first[0])
    own = symbol(p.name)
    written = rf"(?<![A-Za-z\\]){re.escape(own)}(?![A-Za-z])"
    return own if p.form in QUANTITIES and any(re.search(written, line) for line in equation) else ""


def _plain(p: Parameter, value: Any) -> Any:
    """A default as documents write it. Axes and arrays belong to a document: none is a default."""
    if value is dc.MISSING or isinstance(value, Needed) or value is None or p.form in ("axis", "array"):
        return [] if p.form == "axes" else None
    match p.form:
        case "axes":
            return []
        case "part":
            return _json(value)
        case "parts":
            return [_json(v) for v in value]
        case "numbers" | "pairs":
            return dict(value)
        case _:
            return list(value) if isinstance(value, tuple) else value


def _json(part: Part) -> Any:
    """A part as documents write it; arrays, which a document keeps in a file, are left to their defaults."""
    return _without_arrays(to_json(part, lambda axis: "", _nowhere))


def _nowhere(array: FrozenArray) -> str:
    return ""


def _without_arrays(data: Any) -> Any:
    if isinstance(data, dict):
        return {k: _without_arrays(v) for k, v in data.items() if v != {"array": ""}}
    return [_without_arrays(v) for v in data] if isinstance(data, list) else data
