"""The arguments of a world's constructor, as settings that a form can show."""

from __future__ import annotations

import dataclasses as dc
import inspect
from collections.abc import Mapping
from typing import Any, Literal

from deodar import docstring
from deodar.codec import Json
from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds._base import World
from deodar.worlds.recorded_run import Recording

SettingForm = Literal["file", "text", "number", "flag", "numbers"]


@dc.dataclass(frozen=True)
class WorldSetting:
    """An argument of a world's constructor.

    Attributes:
        name: name of the argument.
        form: the type of its value; `file`: the file that the world opens, `numbers`: a list of numbers.
        meaning: its description.
        default: its default; None: it has none, or it is empty.
    """

    name: str
    form: SettingForm
    meaning: str
    default: Json


def world_settings(cls: type, meanings: Mapping[str, str]) -> tuple[WorldSetting, ...]:
    """Return the settings of a world, the argument of `open` first; empty if it cannot be opened.

    Those of a dataclass among the arguments are its fields. Arguments whose values are other objects, such as
    the vehicle of an arena, are left out.
    """
    if not issubclass(cls, World) or (cls.open.__func__ is World.open.__func__ and cls is not Recording):
        return ()
    arguments = list(inspect.signature(cls.__init__).parameters.values())[1:]
    if not arguments:
        return ()
    first, *others = arguments
    name = first.name
    default = first.default if isinstance(first.default, (str, int)) else None
    form: SettingForm = "file" if cls.opens else "text"
    found = [WorldSetting(name, form, meanings.get(name, ""), None if default is None else str(default))]
    if cls is Recording:
        return tuple(found)
    for argument in others:
        if dc.is_dataclass(argument.default):
            found += _fields(argument.default)
        else:
            meaning = meanings.get(argument.name, "")
            found += _setting(argument.name, argument.default, str(argument.annotation), meaning)
    return tuple(found)


def require_settings(cls: type, values: Mapping[str, Any]) -> None:
    """Raise WorldError if values are not of the settings of a world, apart from its first."""
    known = {s.name: s for s in world_settings(cls, {})[1:]}
    for name, value in values.items():
        if name not in known:
            raise WorldError(
                f"there is no setting {name!r}", where=cls.__name__, fix=did_you_mean(name, known)
            )
        if not _FITS[known[name].form](value):
            raise WorldError(f"{name} is {show(value)}", where=cls.__name__)


def _fields(group: Any) -> list[WorldSetting]:
    meanings = docstring.parse(docstring.source(type(group))).entries("Attributes")
    return [
        setting
        for f in dc.fields(group)
        for setting in _setting(f.name, getattr(group, f.name), str(f.type), meanings.get(f.name, ""))
    ]


def _setting(name: str, default: Any, annotation: str, meaning: str) -> list[WorldSetting]:
    form = _form(default, annotation)
    return [] if form is None else [WorldSetting(name, form, meaning, default)]


def _form(default: Any, annotation: str) -> SettingForm | None:
    if isinstance(default, bool):
        return "flag"
    if isinstance(default, (int, float)):
        return "number"
    if isinstance(default, str):
        return "text"
    return "numbers" if default is None and "Sequence[float]" in annotation else None


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


_FITS = {
    "file": lambda value: isinstance(value, str),
    "text": lambda value: isinstance(value, str),
    "number": _is_number,
    "flag": lambda value: isinstance(value, bool),
    "numbers": lambda value: value is None or (isinstance(value, list) and all(map(_is_number, value))),
}
