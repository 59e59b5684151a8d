"""Files that hold a secret of the user: a token of 192 random bits that only this user can read.

A process that can read such a file can act as the user anyway.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import stat
import time
from pathlib import Path

FORM = re.compile(r"^[A-Za-z0-9_-]{32}$")
DAYS = 30
"""Days after which a file that was not used is removed (a guess)."""


def new() -> str:
    """Return a token of 192 random bits."""
    return secrets.token_urlsafe(24)


def read(path: Path) -> str:
    """Return the text of a secret file, and note that it was used.

    Raises:
        OSError: there is no such file, it is not a regular one, or another user owns it or can access it.
        ValueError: it holds no text.
    """
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(descriptor, "rb") as file:
        about = os.fstat(file.fileno())
        if not stat.S_ISREG(about.st_mode):
            raise OSError("it is not a regular file")
        if os.name == "posix" and (about.st_uid != os.geteuid() or about.st_mode & 0o077):
            raise PermissionError("others can access it, or own it")
        text = file.read(256).decode("ascii")
        if os.utime in os.supports_fd:
            os.utime(file.fileno())
    return text


def write(path: Path, text: str) -> None:
    """Make a secret file; files beside it that were not used for `DAYS` days are removed.

    Raises:
        FileExistsError: there is one.
        OSError: the system refused.
    """
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    for other in path.parent.iterdir():
        with contextlib.suppress(OSError):  # another process may have removed it
            if time.time() - other.lstat().st_mtime > DAYS * 86400:
                other.unlink()
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o600)
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(text)
