"""The metaclass of parts: `help`, `inspect.signature` and completion from their declarations."""

from __future__ import annotations

import collections.abc
import dataclasses as dc
import functools
import inspect
import types
import typing
from typing import Any

from deodar import docstring
from deodar.declarations import range_text

_TITLES = ("Parameters", "Attributes")
_NAMES: dict[Any, str] = {type(None): "None", Any: "Any", ...: "..."}


class PartType(type):
    """The metaclass of parts, which derives signature and documentation from the declared parameters.

    `cls.__doc__` is the docstring of the source (`docstring.source`) with units, ranges and the parameters
    that it does not describe.
    """

    @property
    def __doc__(cls) -> str | None:  # pyright: ignore[reportIncompatibleVariableOverride]
        return _documentation(cls) if _finished(cls) else vars(cls).get("__doc__")

    @__doc__.setter
    def __doc__(cls, text: str | None) -> None:  # pyright: ignore[reportIncompatibleVariableOverride]
        type.__dict__["__doc__"].__set__(cls, text)

    @property
    def __signature__(cls) -> inspect.Signature:
        if not _finished(cls):
            raise AttributeError("__signature__")
        return _signature(cls)

    def __dir__(cls) -> list[str]:
        """List the attributes that no base class has, without the parameters, which are in the signature."""
        declared: Any = vars(cls).get("__dataclass_fields__", {})
        return sorted(
            name
            for name in vars(cls)
            if not name.startswith("_")
            and name not in declared
            and not any(name in vars(base) for base in cls.__mro__[1:])
        )


def _finished(cls: type[Any]) -> bool:
    """Return whether `dataclass` has completed the class.

    `dataclass` reads the docstring before that, when annotations may refer to names that are not defined yet.
    """
    return "__match_args__" in vars(cls)


class _Annotation:
    """A type that a signature shows in words."""

    def __init__(self, hint: Any, text: str) -> None:
        self.hint, self.text = hint, text

    def __repr__(self) -> str:
        return self.text


@functools.cache
def _signature(cls: Any) -> inspect.Signature:
    hints = typing.get_type_hints(cls)
    fields = {
        f.name: inspect.Parameter.KEYWORD_ONLY if f.kw_only else inspect.Parameter.POSITIONAL_OR_KEYWORD
        for f in dc.fields(cls)
    }
    found = [
        inspect.Parameter(p.name, fields[p.name], default=_default(p), annotation=_annotation(hints[p.name]))
        for p in cls.__declared__()
    ]
    return inspect.Signature(sorted(found, key=lambda p: p.kind))


def _default(p: Any) -> Any:
    return inspect.Parameter.empty if p.default is dc.MISSING else p.default


def _annotation(hint: Any) -> Any:
    return hint if hint in (bool, float, int, str) else _Annotation(hint, _words(hint))


def _words(hint: Any) -> str:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        return " | ".join(
            dict.fromkeys(_words(each) for each in inner if getattr(each, "__name__", "") != "FrozenArray")
        )
    name = _NAMES.get(hint) if isinstance(hint, collections.abc.Hashable) else None
    name = name or getattr(origin or hint, "__name__", str(hint))
    return f"{name}[{', '.join(map(_words, inner))}]" if inner else name


@functools.cache
def _documentation(cls: Any) -> str:
    """Return the docstring of the source, with unit and range after each parameter, and with the parameters
    that it does not describe: as a base class does, or by name alone.
    """
    text = docstring.source(cls)
    if text.startswith(f"{cls.__name__}("):  # without a docstring in the source, `dataclass` writes the call
        text = ""
    read = docstring.parse(text or f"{cls.__name__}.")
    sections = (title for base in cls.__mro__ for title in docstring.parse(docstring.source(base)).sections)
    title = next((title for title in sections if title in _TITLES), _TITLES[0])
    declared = {p.name: p for p in cls.__declared__()}
    own, inherited = read.blocks(title), docstring.described(cls)
    entries = dict[str, list[str]]()
    for p in declared.values():
        if p.name != "name" or p.name in inherited:
            entries[p.name] = [*inherited.get(p.name, (f"{p.name}:",))]
    entries |= own
    for name in entries.keys() & declared.keys():
        entries[name][-1] += _range(declared[name])
    body = "\n".join(line for entry in entries.values() for line in entry)
    return str(docstring.Docstring(read.opening, {**read.sections, **({title: body} if body else {})}))


def _range(p: Any) -> str:
    choices = f"one of {', '.join(p.choices)}" if p.choices else ""
    said = [f"unit {p.unit}" if p.unit else "", range_text(p.lower, p.upper), choices]
    return f" [{'; '.join(filter(None, said))}]" if any(said) else ""
