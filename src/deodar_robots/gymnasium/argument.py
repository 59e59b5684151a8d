"""Parser of environments on the command line: the name and the settings."""

from __future__ import annotations

from typing import Any

from deodar import codec
from deodar.errors import WorldError

OWN = ("period", "at_end")
"""Settings of the world; all others are those of the environment."""

WORDS = {"yes": True, "true": True, "no": False, "false": False, "none": None}


def parse_argument(argument: str) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """Parse `NAME, SETTING=VALUE, ...` into the name, settings of the world, and those of the environment.

    An example is `MountainCarContinuous-v0, period=10, goal_velocity=0.02`. A value is a number, yes, no,
    none, or text.

    Raises:
        WorldError: a piece is no setting.
    """
    where = f"gym:{argument}"
    name, *pieces = (piece.strip() for piece in argument.split(","))
    if not name:
        raise WorldError("needs the name of an environment", where=where, fix="Write gym:CartPole-v1")
    require_registered(name, where)
    own, settings = dict[str, Any](), dict[str, Any]()
    for piece in pieces:
        key, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or not key.isidentifier():
            raise WorldError(f"{piece!r} is no setting", where=where, fix="Write NAME=VALUE after a comma")
        (own if key in OWN else settings)[key] = _value(value)
    return name, own, settings


def require_registered(name: str, where: str) -> None:
    """Refuse `MODULE:NAME`, which would import the module: text of files and records runs no code."""
    if ":" in name:
        raise WorldError(
            f"{name!r} names a module, which is not imported from text",
            where=where,
            fix="In a script: dd.Gymnasium(...) of a function that returns the environment",
        )


def _value(text: str) -> Any:
    if text.lower() in WORDS:
        return WORDS[text.lower()]
    try:
        found = codec.parse(text)
    except ValueError:
        return text
    return found if isinstance(found, (int, float)) else text
