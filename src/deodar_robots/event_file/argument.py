"""Parser of event files on the command line: the file and the settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from deodar.errors import WorldError, did_you_mean
from deodar.parameters import show

FLAGS = {"yes": True, "true": True, "no": False, "false": False}
NAMES = ("period", "loop", "size", "stream", "jaer")


def parse_argument(argument: str) -> tuple[str, dict[str, Any]]:
    """Parse `FILE, NAME=VALUE, ...` into the path of a file and settings.

    An example is `hand.aedat, period=5, loop=yes, size=346x260`. A comma in the name of an existing file is
    part of the name.

    Raises:
        WorldError: a setting is unknown, or its value is invalid.
    """
    file, found = argument.strip(), dict[str, Any]()
    while "," in file and not Path(file).exists():
        file, _, piece = file.rpartition(",")
        name, equal, value = (part.strip() for part in piece.partition("="))
        if not equal or name not in NAMES:
            raise WorldError(
                f"there is no setting {show(name)}",
                where=f"event-file:{argument}",
                fix=did_you_mean(name, NAMES),
            )
        found[name] = _value(name, value, argument)
        file = file.strip()
    return file, found


def _value(name: str, value: str, argument: str) -> Any:
    try:
        if name in ("loop", "jaer"):
            return FLAGS[value.lower()]
        if name == "size":
            columns, rows = value.split("x")
            return int(columns), int(rows)
        return float(value) if name == "period" else int(value)
    except (KeyError, ValueError):
        expected = {"period": "a number of ms", "size": "columns and rows, such as 346x260", "stream": "0, 1"}
        raise WorldError(
            f"{name} is {show(value)}; expected {expected.get(name, 'yes or no')}",
            where=f"event-file:{argument}",
        ) from None
