"""Worlds by their names on the command line, in the studio and in records; records in an argument are read
first.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from deodar.codec import Json
from deodar.recording import files
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._naming import named_kind
from deodar.worlds.recorded_run import Recording


def opened(kind: type[World], argument: str) -> World:
    """Return a world of a kind, from the argument after the colon of `--world KIND:ARGUMENT`."""
    if issubclass(kind, Recording):
        return kind(files.load_record(Path(argument)), argument)
    with errors_of(kind, "open", argument):
        return kind.open(argument)


def again(kind: type[World], described: Mapping[str, Json]) -> World:
    """Return the world that a record describes."""
    if issubclass(kind, Recording):
        return opened(kind, str(described.get("file", "")))
    with errors_of(kind, "again"):
        return kind.again(described)


def named(text: str, where: str) -> World:
    """Return the world that `KIND:ARGUMENT` names; messages call the place of this text `where`."""
    return opened(*named_kind(text, where))
