"""Files and folders beside their final ones, while they are written.

The name follows from the final one, and its writer holds a lock, which the system releases when the process
ends, however it ends. So a process that is killed leaves at most one, which the next process that writes the
same file takes over, and processes that write it at once get names of their own. Windows, and file systems
without locks, have no such lock; there each name is a new one, and what a killed process leaves stays.
`deodar doctor` names what is left, where there are locks.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import re
import shutil
import stat
import tempfile
from collections.abc import Generator, Iterator
from pathlib import Path

SEVERAL = 8
"""Processes that may write one file at once, before they get random names."""

TRIES = 20
"""Attempts to open a file that others rename at the same time."""

OLD = "old"
"""Name in a partial folder of what is being replaced."""

FORM = re.compile(r"\..*\.[0-9a-f]{6}\.partial.*")
"""Form of the names."""

FLAGS = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)


@contextlib.contextmanager
def file(path: Path) -> Generator[Path]:
    """Yield an empty file beside a path, which only this user may read; it is removed unless it was renamed.

    Raises:
        OSError: the system refused.
    """
    taken = take(path.name, str(path.parent))
    if taken is None:
        handle, name = tempfile.mkstemp(prefix=f"{_stem(path.name)}-", suffix=path.suffix, dir=path.parent)
        os.close(handle)
        try:
            yield Path(name)
        finally:
            Path(name).unlink(missing_ok=True)
        return
    name, handle = taken
    try:
        os.fchmod(handle, 0o600)
        yield path.with_name(name)
    finally:
        drop(name, handle, str(path.parent))


@contextlib.contextmanager
def folder(path: Path) -> Generator[Path]:
    """Yield an empty folder beside a path; it is removed at the end.

    A process that was killed while it replaced a folder left the old one in it, which gets its name again.

    Raises:
        OSError: the system refused.
    """
    beside, handle = _taken_folder(path)
    try:
        if (beside / OLD).exists() and not os.path.lexists(path):
            (beside / OLD).rename(path)
        for inner in beside.iterdir():
            shutil.rmtree(inner, ignore_errors=True)
        yield beside
    finally:
        if (beside / OLD).exists() and not os.path.lexists(path):
            (beside / OLD).rename(path)
        shutil.rmtree(beside, ignore_errors=True)
        if handle is not None:
            os.close(handle)


def take(name: str, folder: str = "", descriptor: int | None = None) -> tuple[str, int] | None:
    """Return the name and the locked handle of an empty file beside another one; None: it cannot be locked.

    Args:
        name: name of the final file.
        folder: its folder.
        descriptor: its folder, opened, in place of `folder`.
    """
    if os.name != "posix":
        return None
    for number in range(SEVERAL):
        beside = _name(name, number)
        place = os.path.join(folder, beside)
        for _ in range(TRIES):
            try:
                handle = os.open(place, FLAGS, 0o666, dir_fd=descriptor)
            except OSError:  # also the file of another user
                return None
            locked = _lock(handle)
            if locked and _is(handle, place, descriptor):
                os.ftruncate(handle, 0)
                return beside, handle
            os.close(handle)
            if locked is None:
                with contextlib.suppress(OSError):
                    os.unlink(place, dir_fd=descriptor)
                return None
            if not locked:
                break
    return None


def drop(name: str, handle: int, folder: str = "", descriptor: int | None = None) -> None:
    """Remove what `take` returned, unless it was renamed, and release it."""
    place = os.path.join(folder, name)
    with contextlib.suppress(OSError):
        if _is(handle, place, descriptor):
            os.unlink(place, dir_fd=descriptor)
    os.close(handle)


def abandoned(folder: Path) -> Iterator[Path]:
    """Yield the partial files and folders in a folder that no process writes."""
    for path in sorted(folder.iterdir()):
        if FORM.fullmatch(path.name):
            handle, _ = _lock_existing(path)
            if handle is not None:
                os.close(handle)
                yield path


def _taken_folder(path: Path) -> tuple[Path, int | None]:
    """Return a folder beside a path, and its locked handle; None: it has a name of its own instead."""
    for number in range(SEVERAL if os.name == "posix" else 0):
        beside = path.with_name(_name(path.name, number))
        with contextlib.suppress(FileExistsError):
            beside.mkdir(mode=0o700)
        handle, taken = _lock_existing(beside)
        if handle is not None:
            return beside, handle
        if not taken:  # no locks, or the folder of another user
            with contextlib.suppress(OSError):
                beside.rmdir()
            break
    return Path(tempfile.mkdtemp(prefix=f"{_stem(path.name)}-", dir=path.parent)), None


def _stem(name: str) -> str:
    """Return the beginning of the names beside a file: machines that share a folder may not share locks."""
    machine = hashlib.sha256(platform.node().encode()).hexdigest()[:6]
    return f".{name[:40]}.{machine}.partial"


def _name(name: str, number: int) -> str:
    return f"{_stem(name)}{f'-{number}' if number else ''}{Path(name).suffix}"


def _lock_existing(place: Path) -> tuple[int | None, bool]:
    """Return the locked handle of an existing file or folder, and whether another process holds it."""
    if os.name != "posix":
        return None, False
    try:
        handle = os.open(place, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW | os.O_CLOEXEC)
    except OSError:
        return None, False
    locked = _lock(handle)
    if locked and _is(handle, str(place), None):
        return handle, False
    os.close(handle)
    return None, locked is not None


def _lock(handle: int) -> bool | None:
    """Lock an open file; False: another process holds the lock, None: the file system has no locks."""
    # only POSIX systems have this module
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def _is(handle: int, place: str, descriptor: int | None) -> bool:
    """Return whether an open file of this user has one name, this one: it may have been renamed meanwhile."""
    try:
        mine, named = os.fstat(handle), os.stat(place, dir_fd=descriptor, follow_symlinks=False)
    except OSError:
        return False
    single = stat.S_ISDIR(mine.st_mode) or (stat.S_ISREG(mine.st_mode) and mine.st_nlink == 1)
    return single and mine.st_uid == os.geteuid() and os.path.samestat(mine, named)
