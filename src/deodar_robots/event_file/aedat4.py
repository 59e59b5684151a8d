"""AEDAT4, the files of DV: read by the package `aedat` (extra `events`), in a child process."""

from __future__ import annotations

import importlib.util
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import MissingExtra, RunWarning, WorldError
from deodar.guarded.guarded_file import GuardedFile
from deodar_robots.event_file.events import MOST_EVENTS, RecordedEvents, ordered, require_size

VERSION = b"#!AER-DAT4"
"""Beginning of a file of this version."""

MOST_BYTES = 2**33
"""Most memory of the child: a small file may state a huge array."""

PATIENCE = 20.0
"""Seconds within which the child opens the file, and reads each packet of events."""


class _Answer:
    """What the child said about a file.

    Attributes:
        streams: types and sizes of all streams; "" if the file has no readable header.
        size: columns and rows of the chosen stream, or None.
        parts: arrays of time, column, row and polarity of each packet.
        problem: why the file was not read to its end; "" if it was.
    """

    def __init__(self, path: Path, stream: int) -> None:
        self.streams, self.problem = "", ""
        self.size: tuple[int, int] | None = None
        self.parts: list[list[np.ndarray]] = []
        guard = GuardedFile(WorldError, str(path), MOST_BYTES, PATIENCE)
        messages = guard.items(packets_of, str(path), stream)
        count = 0
        try:
            for message in messages:
                if isinstance(message[0], str):
                    self.streams, *size = message
                    self.size = (size[0], size[1]) if size else None
                    continue
                self.parts.append(message)
                count += len(self.parts[-1][0])
                if count > MOST_EVENTS:
                    break
        except WorldError as error:
            self.problem = error.problems[0].what.removeprefix("cannot be read: ")
        finally:
            messages.close()
        if count > MOST_EVENTS:
            raise WorldError(f"holds more than {MOST_EVENTS} events, the most that are read", where=str(path))


def packets_of(path: str, stream: int) -> Iterator[list[Any]]:
    """Yield the types and sizes of all streams as a text, with columns and rows of the chosen one; then time,
    column, row and polarity of the events of each of its packets; in a child process.

    Args:
        path: the file.
        stream: position of the stream among those with events.

    Raises:
        WorldError: the file is damaged.
    """
    # an extra
    import aedat

    try:
        decoder = aedat.Decoder(path)
        streams = sorted(decoder.id_to_stream().items())
        shapes = {k: (s["width"], s["height"]) for k, s in streams if s["type"] == "events"}
        others = [s["type"] for k, s in streams if k not in shapes]
        chosen = [k for number, k in enumerate(shapes) if number == stream]
        texts = ", ".join([*(f"events {w} x {h}" for w, h in shapes.values()), *others])
        yield [texts, *(shapes[chosen[0]] if chosen else ())]
        for packet in decoder if chosen else ():
            if packet["stream_id"] == chosen[0] and "events" in packet:
                e = packet["events"]
                yield [e["t"].astype(np.int64), e["x"], e["y"], e["on"]]
    except (GeneratorExit, MemoryError):
        raise
    except BaseException as error:  # a panic of Rust is no Exception; the package can read on after it
        raise WorldError(f"{type(error).__name__}: {error}"[:300]) from None


def read(path: Path, size: tuple[int, int] | None, stream: int) -> RecordedEvents:
    """Read the events of one stream of a file; frames and all other data are left out.

    Of a file that is damaged or cut off the events before the damage are read, with a `RunWarning`.

    Args:
        path: the file.
        size: columns and rows of the sensor; None: those that the file states.
        stream: position of the stream among those with events.

    Raises:
        MissingExtra: the package `aedat` is not installed.
        WorldError: the file cannot be read, or has no such stream or no events; and the errors of `ordered`.
    """
    where = str(path)
    if importlib.util.find_spec("aedat") is None:
        raise MissingExtra("aedat", "events", "reading an AEDAT4 file")
    answer = _Answer(path, stream)
    if answer.size is None:
        if answer.problem:
            raise WorldError(
                f"cannot be read as AEDAT4 ({answer.problem})", where=where, fix="Record the file again"
            )
        raise WorldError(
            f"has no stream {stream} with events; its streams: {answer.streams or 'none'}",
            where=where,
            fix="Count the streams with events from 0, for example stream=0",
        )
    require_size(answer.size, where)
    if not answer.parts or not sum(len(part[0]) for part in answer.parts):
        because = f" before it is damaged ({answer.problem})" if answer.problem else ""
        raise WorldError(f"holds no events{because}", where=where, fix="Name a recording with events")
    times, columns, rows, on = (np.concatenate(arrays) for arrays in zip(*answer.parts, strict=True))
    if answer.problem:
        text = f"is damaged after {len(times)} events ({answer.problem}); those before are used"
        warnings.warn(f"{where}: {text}", RunWarning, stacklevel=2)
    return ordered(times, columns, rows, on, size or answer.size, where)
