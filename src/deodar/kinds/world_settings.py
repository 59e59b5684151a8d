"""The arguments of a world's constructor, as settings that a form can show."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from typing import Any, Literal

from deodar import docstring
from deodar.codec import Json
from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show
from deodar.worlds._base import World
from deodar.worlds._settings import SettingForm, form_of, groups, settings
from deodar.worlds.recorded_run import Recording


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
    form: SettingForm | Literal["file"]
    meaning: str
    default: Json


def world_settings(cls: type, meanings: Mapping[str, str]) -> tuple[WorldSetting, ...]:
    """Return the settings of a world, the argument of `open` first; empty if it cannot be opened.

    Those of a dataclass among the arguments are its fields. Arguments whose values are other objects, such as
    the vehicle of an arena, are left out.
    """
    if not issubclass(cls, World) or (cls.open.__func__ is World.open.__func__ and cls is not Recording):
        return ()
    declared = settings(cls)
    if not declared:
        return ()
    name, (default, _) = next(iter(declared.items()))
    shown = str(default) if isinstance(default, (str, int)) else None
    first = WorldSetting(name, "file" if cls.opens else "text", meanings.get(name, ""), shown)
    if cls is Recording:
        return (first,)
    for group in groups(cls).values():
        parsed = docstring.parse(docstring.source(type(group)))
        meanings = {**meanings, **parsed.entries("Attributes")}
    others: list[WorldSetting] = []
    for name, (default, annotation) in list(declared.items())[1:]:
        form = form_of(default, annotation)
        if form is not None and (default is None) == (form == "numbers"):
            others.append(WorldSetting(name, form, meanings.get(name, ""), default))
    return first, *others


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


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


_FITS = {
    "file": lambda value: isinstance(value, str),
    "text": lambda value: isinstance(value, str),
    "number": _is_number,
    "flag": lambda value: isinstance(value, bool),
    "numbers": lambda value: value is None or (isinstance(value, list) and all(map(_is_number, value))),
}
