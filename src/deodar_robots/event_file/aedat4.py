"""AEDAT4, the files of DV: read by the package `aedat` (extra `events`), in a process of its own."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import subprocess
import sys
import threading
import warnings
from collections.abc import Generator
from pathlib import Path
from typing import IO

import numpy as np

from deodar.errors import MissingExtra, RunWarning, WorldError
from deodar_robots.event_file.events import MOST_EVENTS, RecordedEvents, ordered, require_size

VERSION = b"#!AER-DAT4"
"""Beginning of a file of this version."""

FIELDS = (np.dtype(np.int64), np.dtype(np.uint16), np.dtype(np.uint16), np.dtype(bool))
"""Types of time, column, row and polarity."""

PATIENCE = 20.0
"""Seconds within which the process answers, and another one for each MB of the file."""

ENDED = "the reader ended"


class Aedat4Process:
    """The process that reads files; it is started when the first one is read, and again if it ended."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def read(self, path: Path, stream: int) -> _Answer:
        """Return what the process says about a file."""
        if self._process is None or self._process.poll() is not None:
            self.close()
            self._process = self._start()
        process, answer = self._process, _Answer()
        timer = threading.Timer(PATIENCE + path.stat().st_size / 1e6, process.kill)
        timer.start()
        try:
            assert process.stdin is not None and process.stdout is not None
            process.stdin.write(f"{os.fsencode(path.resolve()).hex()} {stream}\n".encode())
            process.stdin.flush()
            answer.take(process.stdout)
        except BrokenPipeError:
            answer.problem = ENDED
        except WorldError:
            self.close()
            raise
        finally:
            timer.cancel()
            if answer.problem == ENDED:
                self.close()
        return answer

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            process, self._process = self._process, None
            process.kill()
            process.communicate()

    def _start(self) -> subprocess.Popen[bytes]:
        if importlib.util.find_spec("aedat") is None:
            raise MissingExtra("aedat", "events", "reading an AEDAT4 file")
        env = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "RUST_BACKTRACE": "0"}
        program = Path(__file__).with_name("aedat4_process.py")
        return subprocess.Popen(
            [sys.executable, "-P", str(program)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**env, "OPENBLAS_NUM_THREADS": "1"},
        )


class _Answer:
    """What the process said about a file.

    Attributes:
        streams: types and sizes of all streams; "" if the file has no readable header.
        size: columns and rows of the chosen stream, or None.
        parts: arrays of time, column, row and polarity of each packet.
        problem: why the file was not read to its end; "" if it was.
    """

    def __init__(self) -> None:
        self.streams, self.problem = "", ""
        self.size: tuple[int, int] | None = None
        self.parts: list[list[np.ndarray]] = []

    def take(self, output: IO[bytes]) -> None:
        """Read messages until the last one about this file."""
        count = 0
        while True:
            word, _, rest = output.readline().decode(errors="replace").rstrip("\n").partition(" ")
            if word == "end":
                return
            if word == "error":
                self.problem = rest
                return
            if word == "streams":
                self.streams = rest
            elif word == "size":
                columns, rows = rest.split()
                self.size = int(columns), int(rows)
            elif word == "events":
                count += int(rest)
                if count > MOST_EVENTS:
                    raise WorldError(f"holds more than {MOST_EVENTS} events, the most that are read")
                part = [np.frombuffer(output.read(int(rest) * t.itemsize), t) for t in FIELDS]
                if len(part[-1]) < int(rest):
                    self.problem = ENDED
                    return
                self.parts.append(part)
            else:
                self.problem = ENDED
                return


@contextlib.contextmanager
def process() -> Generator[Aedat4Process]:
    """Return a process that reads files inside this context."""
    reader = Aedat4Process()
    try:
        yield reader
    finally:
        reader.close()


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
    with process() as reader:
        try:
            answer = reader.read(path, stream)
        except WorldError as error:
            raise WorldError(error.problems[0].what, where=where) from None
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
