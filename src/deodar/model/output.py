"""The only writer of files.

A file is written beside its final path, flushed to the disk, and renamed; lines are appended completely or
not at all. An existing file is replaced only with `force`, or if the running script wrote it (`written.py`).
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.errors import Fix, OutputError, OutputExists
from deodar.model import partial, written

THREADS = 16
"""Number of files that are flushed to the disk at the same time (a guess)."""

UNSUPPORTED = (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)
"""Errors of file systems that cannot flush to the disk."""


def location(path: Any) -> Path:
    """Return a path from the value that a script passed; raise if it cannot be one."""
    try:
        file = Path(path)
        os.fsencode(file)
    except (TypeError, ValueError):
        raise OutputError(f"needs the path of a file, not {path!r}") from None
    if "\0" in str(file):
        raise OutputError(f"{path!r} cannot be the path of a file")
    return file


def claim(path: str | Path, force: bool = False) -> Path:
    """Return the path if it may be written: a new file, or a regular file that may be replaced, because of
    `force` or because the running script wrote it.
    """
    path = location(path)
    try:
        taken = path.is_symlink() or path.exists()
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    if taken:
        if not path.is_file() or path.is_symlink():
            raise OutputExists("exists and is not a regular file", where=str(path), fix="Choose another name")
        require_replaceable(path, force)
    parent = path.parent
    if not parent.is_dir():
        raise OutputError(f"the folder {str(parent)!r} does not exist", where=str(path))
    if not os.access(parent, os.W_OK):
        raise OutputError(f"the folder {str(parent)!r} cannot be written to", where=str(path))
    return path


def require_replaceable(path: Path, force: bool = False) -> None:
    """Refuse an existing file or folder that the running script has not written, unless with `force`."""
    if not force and not written.owned(path):
        raise OutputExists(
            "exists already",
            where=str(path),
            fix=Fix(
                "Choose another name, or replace it: force=True",
                "Choose another name, or replace it: --force",
                "Choose another name",
            ),
        )


def note(path: Path) -> None:
    """Note that the running script has written a file or folder, so that it may replace it.

    A list that cannot be written is left as it is: the file is then refused.
    """
    if not (name := written.script()):
        return
    file, states = written.listed(name)
    present = {place: state for place, state in states.items() if os.path.lexists(place)}
    present[str(path.resolve())] = written.state(path)
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        replace(file, codec.line({"script": name, "files": present}).encode())


def write(
    path: Path, content: bytes | Callable[[Path], None], durable: bool = True, private: bool = False
) -> None:
    """Write a file beside its final path, flush it to the disk, and rename it: it is complete or absent.

    Args:
        path: the file; `claim` has checked that it may be written.
        content: its bytes, or a function that writes them to the path that it receives.
        durable: wait for the disk; False for files that can be made again, such as a cache, which no script
            writes by itself.
        private: only this user may read the file; otherwise it gets the permissions of a new file.

    Raises:
        OutputError: the system refused; an existing file is unchanged.
    """
    try:
        with partial.file(path) as beside:
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
            note(path)
    except OSError as error:
        raise failed(path, error) from None


def replace(path: Path, content: bytes) -> None:
    """Write a file beside its final path and rename it, without waiting for the disk.

    For files that a process writes many times a second, into a folder that no other one writes. The name
    beside is the same each time, so that a process that is killed leaves at most one.

    Raises:
        OSError: the system refused; an existing file is unchanged.
    """
    beside = path.with_name(f".{path.name}.partial")
    try:
        with beside.open("wb", buffering=0) as file:
            unwritten = memoryview(content)
            while unwritten:
                unwritten = unwritten[file.write(unwritten) :]
        beside.replace(path)
    except OSError:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise


def append(path: Path, content: bytes) -> None:
    """Append to a file or create it; the content is on the disk when this returns.

    Raises:
        OutputError: the system refused; the file has its previous length.
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
            os.truncate(path, size)  # no partial line, which the next append would continue
        raise failed(path, error) from None


def failed(path: Path, error: OSError) -> OutputError:
    """Return the error of a write that the system refused; the caller still has the data."""
    room = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    fix = "The data are still in memory: make room, or write them to another disk" if room else ""
    return OutputError(f"cannot be written: {error.strerror or error}", where=str(path), fix=fix)


def sync(path: Path) -> None:
    """Wait until the content of a file is on the disk.

    Raises:
        OSError: the disk is full or broken; some file systems report this only here.
    """
    _sync(path, os.O_RDWR)


def sync_folder(path: Path) -> None:
    """Wait until the names in a folder are on the disk; Windows has no call for this."""
    if os.name == "posix":
        _sync(path, os.O_RDONLY)


def sync_tree(path: Path) -> None:
    """Wait until a folder and everything below it are on the disk.

    Several files at a time: a disk takes about as long as for one.
    """
    folders = list(os.walk(path, topdown=False))
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(sync, [Path(folder, name) for folder, _, names in folders for name in names]))
        list(pool.map(sync_folder, [Path(folder) for folder, _, _ in folders]))


def sync_open(handle: int) -> None:
    """Wait until the content of an open file or folder is on the disk, if the file system can report it.

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
