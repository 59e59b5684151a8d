"""The lock of a record that is being written: one process writes it, and others see whether one still does.

The system releases the lock when its process ends, however it ends. The lock is on the folder of the record,
which Windows cannot open; there, and on file systems without locks, nothing is locked.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Generator
from pathlib import Path

from deodar.errors import RecordError

TRIES = 20
"""Number of attempts to lock a record: a process that asks whether it is locked holds the lock meanwhile."""

PAUSE = 0.01
"""Time between two attempts, in seconds."""

MOMENT = 0.001
"""Wall time after which a lock that is still held is that of a writer, in seconds; who asks holds it for some
microseconds.
"""

CERTAIN_SECONDS = 1.0
"""Wall time after which a record without a writer and without growth is no longer written, in seconds.

A writer commits more often. On another machine that shares the folder its lock may not be seen.
"""

Stamp = tuple[int, ...]
"""What changes with every commit of a record."""


def lock(path: Path) -> int | None:
    """Return an open handle of the folder, locked as long as it is open; None: it cannot be locked.

    Raises:
        RecordError: another process writes this record.
    """
    if os.name != "posix":
        return None
    for attempt in range(TRIES):
        handle, taken = _try(path)
        if not taken:
            return handle
        if attempt < TRIES - 1:
            time.sleep(PAUSE)
    raise RecordError(
        "is being written by another process", where=str(path), fix="Wait until it ends, or stop it"
    )


@contextlib.contextmanager
def locked(path: Path) -> Generator[None]:
    """Hold the lock of a folder, where it can be locked.

    Raises:
        RecordError: another process writes into it.
    """
    handle = lock(path)
    try:
        yield
    finally:
        if handle is not None:
            os.close(handle)


def is_written(path: Path) -> bool | None:
    """Return whether a process writes a record; None where this is unknown."""
    if os.name != "posix":
        return None
    handle, taken = _try(path)
    if taken:
        time.sleep(MOMENT)  # another process that only asks has ended
        handle, taken = _try(path)
    if handle is not None:
        os.close(handle)
    return True if taken else None if handle is None else False


def _try(path: Path) -> tuple[int | None, bool]:
    """Try to lock a folder; return its open handle, and whether another process holds the lock."""
    # only POSIX systems have this module
    import fcntl

    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        return None, False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(handle)
        return None, isinstance(error, BlockingIOError)
    return handle, False


def stamp(path: Path) -> Stamp:
    """Return what changes with every commit of a record; empty if it cannot be read."""
    inner = path / "zarr.json"
    try:
        status = (inner if inner.is_file() else path).stat()
    except OSError:
        return ()
    return status.st_ino, status.st_mtime_ns, status.st_size


class WriterWatch:
    """Finds out that no process writes an incomplete record any more, for example because it was killed.

    Args:
        path: the record itself, as `recording.files.locate` returns it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._since: tuple[Stamp, float] | None = None

    def ended(self) -> bool:
        """Return whether the record had no writer and did not grow since a call CERTAIN_SECONDS ago."""
        if is_written(self.path) is not False:
            self._since = None
            return False
        seen, moment = stamp(self.path), time.monotonic()
        if self._since is None or self._since[0] != seen:
            self._since = seen, moment
        return moment - self._since[1] >= CERTAIN_SECONDS
