"""Files that hold a secret of the user: a token of 192 random bits that only this user can read.

A process that can read such a file can act as the user anyway.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shlex
import stat
import time
from pathlib import Path

FORM = re.compile(r"^[A-Za-z0-9_-]{32}$")
DAYS = 30
"""Days after which a file that was not used is old (a guess)."""


class NotPrivate(PermissionError):
    """Other users can access a secret file, or change its folder.

    Attributes:
        command: what ends that in a shell; "" if another user owns it, or uses the folder.
    """

    def __init__(self, text: str, command: str) -> None:
        super().__init__(text)
        self.command = command


def new() -> str:
    """Return a token of 192 random bits."""
    return secrets.token_urlsafe(24)


def read(path: Path) -> str:
    """Return the text of a secret file, and note that it was used.

    Raises:
        NotPrivate: another user owns it or can access it, or can change its folder.
        OSError: there is no such file, or it is not a regular one.
        ValueError: it holds no text.
    """
    _require_own(path.parent)
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(descriptor, "rb") as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError("it is not a regular file")
        if os.name == "posix" and (status.st_uid != os.geteuid() or status.st_mode & 0o077):
            command = f"chmod 600 {shlex.quote(str(path))}" if status.st_uid == os.geteuid() else ""
            raise NotPrivate("others can access it, or own it", command)
        text = file.read(256).decode("ascii")
        # the time of a file on a disk that is only read stays
        with contextlib.suppress(OSError):
            if os.utime in os.supports_fd:
                os.utime(file.fileno())
    return text


def write(path: Path, text: str) -> None:
    """Make a secret file.

    Raises:
        FileExistsError: there is one.
        NotPrivate: another user can change its folder.
        OSError: the system refused.
    """
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    _require_own(path.parent)
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o600)
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(text)


def remove_old(folder: Path) -> None:
    """Remove the files of a folder that were not used for `DAYS` days."""
    for file in folder.iterdir() if folder.is_dir() else ():
        with contextlib.suppress(OSError):  # another process may have removed it
            if time.time() - file.lstat().st_mtime > DAYS * 86400:
                file.unlink()


def _require_own(folder: Path) -> None:
    """Refuse a folder in which another user can replace files."""
    status = folder.stat()
    if os.name == "posix" and (status.st_uid not in (os.geteuid(), 0) or status.st_mode & 0o022):
        # a folder in which users may not remove files of others, such as /tmp, is meant for all of them
        alone = status.st_uid == os.geteuid() and not status.st_mode & stat.S_ISVTX
        command = f"chmod go-w {shlex.quote(str(folder))}" if alone else ""
        raise NotPrivate(f"others can change its folder, {folder}", command)
