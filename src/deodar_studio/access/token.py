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
from pathlib import Path

from deodar import private_file
from deodar.errors import OutputError

VARIABLE = "DEODAR_TOKEN"


def stated() -> str:
    """Return the token that the environment states, empty if none.

    Raises:
        OutputError: it has not the form of the tokens of `private_file.new`: it could be guessed, or would
            not pass through a cookie.
    """
    token = os.environ.get(VARIABLE, "")
    if token and not private_file.FORM.match(token):
        raise OutputError(
            f"{VARIABLE} is no token of 32 letters, digits, - and _",
            fix='Make one: python -c "import secrets; print(secrets.token_urlsafe(24))"',
        )
    return token


def kept(folder: Path, port: int) -> str:
    """Return the token of a port that is stored in `folder`, else a new one.

    A new token is stored if the folder can be written. One that others can read is not used.
    """
    place = folder / "tokens" / str(port)
    with contextlib.suppress(OSError, ValueError):
        found = private_file.read(place)
        if private_file.FORM.match(found):
            return found
    token = private_file.new()
    with contextlib.suppress(OSError):
        place.unlink(missing_ok=True)
        private_file.remove_old(place.parent)
        private_file.write(place, token)
    return token
