"""The token that opens a studio.

A studio that listens on this machine alone keeps its token for its port, in a file that only this user can
read: after a restart at the same port open pages connect again. Whoever can read that file can act as the
user anyway. A studio that listens beyond this machine takes a new token at each start, because its connection
is not encrypted.
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
"""Tokens of ports that were not used for this long are removed (a guess)."""


def new() -> str:
    """A token of 192 random bits."""
    return secrets.token_urlsafe(24)


def kept(folder: Path, port: int) -> str:
    """The token of a port: the one that `folder` keeps, else a new one, which is kept from then on if the
    folder can be written.
    """
    place = folder / "tokens" / str(port)
    found = _read(place)
    if found:
        with contextlib.suppress(OSError):
            os.utime(place)
        return found
    token = new()
    with contextlib.suppress(OSError):
        place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        _forget_old(place.parent)
        place.unlink(missing_ok=True)
        descriptor = os.open(
            place, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o600
        )
        with os.fdopen(descriptor, "w", encoding="ascii") as file:
            file.write(token)
    return token


def _read(place: Path) -> str:
    """A token that was kept; empty if the file is not a regular one of this user alone."""
    try:
        descriptor = os.open(place, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with os.fdopen(descriptor, "rb") as file:
            about = os.fstat(file.fileno())
            own = os.name != "posix" or (about.st_uid == os.geteuid() and not about.st_mode & 0o077)
            text = file.read(64).decode("ascii") if own and stat.S_ISREG(about.st_mode) else ""
    except (OSError, ValueError):
        return ""
    return text if FORM.match(text) else ""


def _forget_old(folder: Path) -> None:
    for path in folder.iterdir():
        if time.time() - path.stat().st_mtime > DAYS * 86400:
            path.unlink(missing_ok=True)
