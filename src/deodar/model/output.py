"""The one writer of files. A file is written beside its final place, waited for until it is on the disk, and
renamed; lines are appended whole or not at all. A file that exists is replaced only where the caller says so.
"""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from deodar.errors import OutputError, OutputExists

THREADS = 16
"""Files whose way to the disk is waited for at a time (a guess)."""

UNSUPPORTED = (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)
"""What file systems answer that cannot be told to put something on the disk."""


def location(path: Any) -> Path:
    """A path from what a script gave; what cannot be one is an error."""
    try:
        found = Path(path)
        os.fsencode(found)
    except (TypeError, ValueError):
        raise OutputError(f"needs the path of a file, not {path!r}") from None
    if "\0" in str(found):
        raise OutputError(f"{path!r} cannot be the path of a file")
    return found


def claim(path: str | Path, force: bool = False) -> Path:
    """The path, if it may be written: free, or a regular file that `force` allows to be replaced."""
    path = location(path)
    try:
        taken = path.is_symlink() or path.exists()
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    if taken:
        if not path.is_file() or path.is_symlink():
            raise OutputExists("exists and is not a regular file", where=str(path), fix="Choose another name")
        if not force:
            raise OutputExists(
                "exists already",
                where=str(path),
                fix="Choose another name, or replace it with --force (force=True)",
            )
    parent = path.parent
    if not parent.is_dir():
        raise OutputError(f"there is no folder {str(parent)!r} to write into", where=str(path))
    if not os.access(parent, os.W_OK):
        raise OutputError(f"the folder {str(parent)!r} cannot be written to", where=str(path))
    return path


def write(
    path: Path, content: bytes | Callable[[Path], None], durable: bool = True, private: bool = False
) -> None:
    """Write beside the final place, wait until it is on the disk, and rename: the file is there whole, or not
    at all.

    Args:
        path: the file; `claim` has said that it may be written.
        content: its bytes, or what writes them into the path that it is given.
        durable: wait for the disk; False is for files that can be made again, such as a cache.
        private: only this user may read the file; otherwise it gets the permissions of a new file.

    Raises:
        OutputError: the system refused; a file that was there is as before.
    """
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name[:40]}.", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    beside = Path(name)
    try:
        if callable(content):
            content(beside)
        else:
            beside.write_bytes(content)
        if not private:
            beside.chmod(0o666 & ~_umask())
        if durable:
            sync(beside)
        beside.replace(path)
        if durable:
            sync_folder(path.parent)
    except OSError as error:
        raise failed(path, error) from None
    finally:
        beside.unlink(missing_ok=True)


def append(path: Path, content: bytes) -> None:
    """Append to a file, or make it; the content is on the disk when this returns.

    Raises:
        OutputError: the system refused; the file ends where it ended before.
    """
    new = not path.exists()
    size = 0 if new else path.stat().st_size
    try:
        with path.open("ab") as file:
            file.write(content)
            file.flush()
            sync_open(file.fileno())
        if new:
            sync_folder(path.parent)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.truncate(path, size)  # no half of a line, which the next one would continue
        raise failed(path, error) from None


def failed(path: Path, error: OSError) -> OutputError:
    """Return the error of a write that the system refused; who asked for it still has the data."""
    room = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    fix = "The data are still in memory: make room, or write them to another disk" if room else ""
    return OutputError(f"cannot be written: {error.strerror or error}", where=str(path), fix=fix)


def sync(path: Path) -> None:
    """Wait until the content of a file is on the disk.

    Raises:
        OSError: the disk is full or broken, which some file systems say only now.
    """
    _sync(path, os.O_RDWR)


def sync_folder(path: Path) -> None:
    """Wait until the names in a folder are on the disk; Windows has no call for this."""
    if os.name == "posix":
        _sync(path, os.O_RDONLY)


def sync_tree(path: Path) -> None:
    """Wait until a folder is on the disk with everything below it; several files at a time, which a disk does
    in about the time of one.
    """
    found = list(os.walk(path, topdown=False))
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(sync, [Path(folder, name) for folder, _, names in found for name in names]))
        list(pool.map(sync_folder, [Path(folder) for folder, _, _ in found]))


def sync_open(handle: int) -> None:
    """Wait until what an open file or folder holds is on the disk, where the file system can tell.

    Raises:
        OSError: the disk is full or broken.
    """
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in UNSUPPORTED:
            raise


def _sync(path: Path, mode: int) -> None:
    handle = os.open(path, mode)
    try:
        sync_open(handle)
    finally:
        os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
