"""The index of a store of records: which object has which trials, with its size, checksum and levels.

It is a file of JSON lines, written when all trials have rows: a header with the checksum of what follows it,
then a line for each object. Without it, or if it is damaged, the names of the objects say which trials they
have.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from deodar import codec, sealed
from deodar.errors import RunWarning
from deodar.experiments.record_target import OBJECTS, RECORD, RecordTarget
from deodar.experiments.rows import Row

INDEX = "index.jsonl"
"""Name of the file."""

VERSION = 1


@dataclass(frozen=True, eq=False)
class IndexedObject:
    """An object of a store.

    Attributes:
        name: its name.
        size: its size in bytes.
        crc32c: its checksum, eight hexadecimal digits; empty: it is not known.
        levels: for each of its trials the level of each factor; None: its own metadata state them.
    """

    name: str
    size: int
    crc32c: str
    levels: Mapping[int, Mapping[str, Any]] | None


def of_rows(rows: Iterable[Row]) -> list[IndexedObject]:
    """Return the objects that rows name, in the order of their first trials; no row is kept."""
    records: dict[str, Any] = {}
    levels: dict[str, dict[int, Any]] = {}
    for row in rows:
        name = row[RECORD]["object"]
        records.setdefault(name, row[RECORD])
        levels.setdefault(name, {})[int(row["trial"])] = row["levels"]
    return [
        IndexedObject(
            name, int(records[name]["size"]), str(records[name]["crc32c"]), dict(sorted(levels_of.items()))
        )
        for name, levels_of in sorted(levels.items(), key=lambda named: min(named[1]))
    ]


def text(objects: Sequence[IndexedObject]) -> bytes:
    """Return the content of the file."""
    trial_levels = [level for record in objects for level in (record.levels or {}).values()]
    factors = list(dict.fromkeys(name for level in trial_levels for name in level))
    lines = [
        codec.line(
            {
                "object": record.name,
                "size": record.size,
                "crc32c": record.crc32c,
                "trials": list(record.levels or {}),
                "levels": [[level.get(name) for name in factors] for level in (record.levels or {}).values()],
            }
        )
        for record in objects
    ]
    body = "".join(f"{line}\n" for line in lines).encode()
    header = {
        "index": VERSION,
        "trials": len(trial_levels),
        "factors": factors,
        "crc32c": sealed.checksum(body),
    }
    return codec.line(header).encode() + b"\n" + body


def parse(content: bytes) -> list[IndexedObject]:
    """Return the objects of a file.

    Raises:
        ValueError: it is damaged, cut, or of a newer version.
    """
    first, _, body = content.partition(b"\n")
    try:
        header = codec.parse(first)
        if header["index"] > VERSION or sealed.checksum(body) != header["crc32c"]:
            raise ValueError
        out: list[IndexedObject] = []
        for line in body.splitlines():
            entry = codec.parse(line)
            if not entry["object"].startswith(f"{OBJECTS}/") or ".." in entry["object"]:
                raise ValueError  # a store that was downloaded may name any file
            labels = [dict(zip(header["factors"], row, strict=True)) for row in entry["levels"]]
            levels = dict(zip(entry["trials"], labels, strict=True))
            out.append(IndexedObject(str(entry["object"]), int(entry["size"]), str(entry["crc32c"]), levels))
        return out
    except (ValueError, LookupError, TypeError, AttributeError):
        raise ValueError("the index is damaged") from None


def write(target: RecordTarget, rows: Iterable[Row]) -> None:
    """Write the index of a store all of whose trials have rows.

    Warns:
        RunWarning: the store holds objects that no row names; they stay.
    """
    store, objects = target.address.open(), of_rows(rows)
    store.put(INDEX, text(objects))
    unnamed = sorted({*store.sizes(OBJECTS)} - {record.name for record in objects})
    if unnamed:
        listed = ", ".join(unnamed[:3]) + (", ..." if len(unnamed) > 3 else "")
        warnings.warn(
            f"{target.address.shown}: {len(unnamed)} files that no row names, of a stopped run or of another"
            f" division into pieces: {listed}. They may be deleted",
            RunWarning,
            stacklevel=3,
        )
