"""The class of parts: what `help`, `inspect.signature` and completion show of them, from their
declarations.
"""

from __future__ import annotations

import collections.abc
import dataclasses as dc
import functools
import inspect
import re
import types
import typing
from typing import Any

_ENTRY = re.compile(r"    (\w+): .*")
_HEADS = ("Parameters:", "Attributes:")
_NAMES: dict[Any, str] = {type(None): "None", Any: "Any", ...: "..."}


class PartType(type):
    """The class of a part: its signature and documentation are those of the declared parameters.

    `cls.__doc__` is the docstring of the source (`source_doc`), with units, ranges and the parameters that it
    does not describe added to it.
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
        """What no base class has, parameters aside: the signature has those, and a contract's methods are
        listed where it is declared.
        """
        declared: Any = vars(cls).get("__dataclass_fields__", {})
        return sorted(
            name
            for name in vars(cls)
            if not name.startswith("_")
            and name not in declared
            and not any(name in vars(base) for base in cls.__mro__[1:])
        )


def _finished(cls: type[Any]) -> bool:
    """Whether `dataclass` has made the class: it asks for the docstring before, when annotations may name
    what is not defined yet.
    """
    return "__match_args__" in vars(cls)


def source_doc(cls: type[Any]) -> str:
    """The docstring of the source, without its indentation; "" where there is none."""
    return inspect.cleandoc(vars(cls).get("__doc__") or "")


class _Annotation:
    """A type that a signature shows in a few plain words."""

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
    """The docstring of the source, with unit and range after each parameter, and the parameters that it does
    not describe.
    """
    text = source_doc(cls)
    lines = (
        [] if text.startswith(f"{cls.__name__}(") else text.splitlines()
    )  # `dataclass` writes the call where there is no docstring
    lines = lines or [f"{cls.__name__}."]
    declared = {p.name: p for p in cls.__declared__()}
    start = next((k + 1 for k, line in enumerate(lines) if line in _HEADS), 0)
    end = (
        next((k for k in range(start, len(lines)) if lines[k] and not lines[k].startswith(" ")), len(lines))
        if start
        else 0
    )
    entries: dict[str, list[str]] = {}
    for line in lines[start:end]:
        if found := _ENTRY.fullmatch(line):
            entries[found[1]] = [line]
        elif line and entries:
            entries[next(reversed(entries))].append(line)
    for p in declared.values():
        if p.name not in entries and p.name != "name":
            entries[p.name] = [f"    {p.name}: {p.meaning}."]
    for name in entries.keys() & declared.keys():
        entries[name][-1] += _range(declared[name])
    body = [line for entry in entries.values() for line in entry]
    if start:
        lines[start:end] = [*body, *([""] if end < len(lines) else [])]
    elif body:
        lines += ["", "Parameters:", *body]
    return "\n".join(lines)


def _range(p: Any) -> str:
    said = [f"unit {p.unit}"] if p.unit else []
    if p.lower is not None and p.upper is not None:
        said.append(f"{p.lower:.12g} to {p.upper:.12g}")
    elif p.lower is not None or p.upper is not None:
        said.append(f"at least {p.lower:.12g}" if p.lower is not None else f"at most {p.upper:.12g}")
    if p.choices:
        said.append(f"one of {', '.join(p.choices)}")
    return f" [{'; '.join(said)}]" if said else ""
