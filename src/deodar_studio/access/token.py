"""The access token of a studio.

A studio that listens on this machine alone stores the token of its port in a file that only this user can
read, so that open pages connect again after a restart at the same port. A process that can read that file can
act as the user anyway. A studio that other machines can reach uses a new token at each start, because its
connection is not encrypted. A program that starts a studio for others, such as a hub of notebooks, states the
token in the environment, which only processes of this user can read.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import stat
import time
from pathlib import Path

from deodar.errors import OutputError

VARIABLE = "DEODAR_TOKEN"
FORM = re.compile(r"^[A-Za-z0-9_-]{32}$")
DAYS = 30
"""Days after which the token of an unused port is removed (a guess)."""


def new() -> str:
    """Return a token of 192 random bits."""
    return secrets.token_urlsafe(24)


def stated() -> str:
    """Return the token that the environment states, empty if none.

    Raises:
        OutputError: it has not the form of the tokens of `new`: it could be guessed, or would not pass
            through a cookie.
    """
    token = os.environ.get(VARIABLE, "")
    if token and not FORM.match(token):
        raise OutputError(
            f"{VARIABLE} is no token of 32 letters, digits, - and _",
            fix='Make one: python -c "import secrets; print(secrets.token_urlsafe(24))"',
        )
    return token


def kept(folder: Path, port: int) -> str:
    """Return the token of a port that is stored in `folder`, else a new one.

    A new token is stored if the folder can be written.
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
    """Return a stored token; empty unless it is a regular file that only this user can access."""
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
