"""Worlds as they are named on the command line, in the studio and in records; those made of records are read first."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deodar.recording import files
from deodar.worlds._base import World
from deodar.worlds.recording import Recording


def opened(kind: type[World], argument: str) -> World:
    """A world of a kind, from what stands after the colon of `--world KIND:ARGUMENT`."""
    if issubclass(kind, Recording):
        return kind(files.load(Path(argument)), argument)
    return kind.open(argument)


def again(kind: type[World], described: Mapping[str, Any]) -> World:
    """The world that a record says it was made with."""
    return opened(kind, str(described.get("file", ""))) if issubclass(kind, Recording) else kind.again(described)
