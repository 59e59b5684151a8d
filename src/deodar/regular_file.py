"""Files that are opened by their names: a regular file, or an error.

A named pipe or a device in place of a file would stop the reader without end, or never end itself. The file
is opened without waiting, and its type is read from what was opened.
"""

from __future__ import annotations

import errno
import os
import stat
from io import BufferedReader

from deodar.errors import DeodarError

WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0)


SPECIAL = "not a regular file"
SAVE_FIRST = "Save its content in a file, and name that file"


def open_binary(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a file for reading.

    Raises:
        OSError: the system refused, or it is no regular file.
    """
    return open(path, "rb", opener=_regular)


def _regular(path: str, flags: int) -> int:
    descriptor = os.open(path, flags | WITHOUT_WAITING)
    mode = os.fstat(descriptor).st_mode
    if stat.S_ISREG(mode):
        return descriptor
    os.close(descriptor)
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    raise OSError(errno.EINVAL, f"it is {SPECIAL}. {SAVE_FIRST}", path)


def refuse_special(path: str | os.PathLike[str], kind: type[DeodarError]) -> None:
    """Raise an error of a kind if a path names a pipe, a device or a socket, such as /dev/stdin."""
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        raise kind(f"is {SPECIAL}", where=os.fspath(path), fix=SAVE_FIRST)


def is_file(path: str | os.PathLike[str]) -> bool:
    """Return whether a path names a regular file; a name that the system refuses, such as one that is too
    long, names none.
    """
    return os.path.isfile(path)


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return the content of a file.

    Raises:
        OSError: the system refused, or it is no regular file.
    """
    with open_binary(path) as file:
        return file.read()


def read_text(path: str | os.PathLike[str], encoding: str = "utf-8") -> str:
    """Return the content of a file of text, its lines end in a line feed.

    Raises:
        OSError: the system refused, or it is no regular file.
        UnicodeDecodeError: it is another encoding.
    """
    return read_bytes(path).decode(encoding).replace("\r\n", "\n")
