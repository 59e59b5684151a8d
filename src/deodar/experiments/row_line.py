"""A line of a file of rows: JSON, whose last entry is the CRC-32C of what precedes it.

A file whose first line has no checksum is of an earlier version: none of its lines has one. Other programs
read the checksum as a column of the rows.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from deodar import codec, sealed
from deodar.codec import Json
from deodar.errors import RecordError, reading

CHECKSUM = "crc32c"
ENDING = re.compile(rb',"' + CHECKSUM.encode() + rb'":"([0-9a-f]{8})"\}\n?$')


def write(data: Json, checked: bool) -> bytes:
    """Return the line of an object, with a checksum if the others of its file have one."""
    content = codec.line(data, ascii=True, finite=True).encode()
    if checked:
        body = content[:-1]
        content = body + f',"{CHECKSUM}":"{sealed.checksum(body)}"}}'.encode()
    return content + b"\n"


def read(line: bytes, checked: bool) -> Any:
    """Return the object of a line, without its checksum.

    Args:
        line: the line.
        checked: whether it must have a checksum; one that it has is compared in any case.

    Raises:
        ValueError: it is not JSON, or not the line that was written.
    """
    ending = ENDING.search(line)
    if ending is None:
        if checked:
            raise ValueError("it has no checksum, as the first line has one")
        return codec.parse(line)
    body = line[: ending.start()]
    if sealed.checksum(body).encode() != ending[1]:
        raise ValueError("its checksum is that of another line")
    return codec.parse(body + b"}")


def read_first(line: bytes, name: str, path: Path) -> tuple[Any, bool]:
    """Return the only entry of the first line, and whether the lines of its file have checksums.

    Args:
        line: the line.
        name: name of the entry.
        path: the file.

    Raises:
        RecordError: the entry is the identity of an experiment of a later version.
        ValueError: the line is damaged, or has no such entry.
    """
    data = read(line, False)
    if not isinstance(data, dict) or list(data) != [name] or not isinstance(data[name], dict):
        raise ValueError(f"its first line is not that of {name!r}")
    if isinstance(data[name].get("experiment"), int):  # rows of other jobs have a name there, or nothing
        # start-up time: this brings JAX
        from deodar.experiments.experiment_migrations import require_readable

        with reading(path, RecordError):
            require_readable(data[name])
    return data[name], ENDING.search(line) is not None
