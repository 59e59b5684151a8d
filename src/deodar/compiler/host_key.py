"""The key by which hosts that compute one model together prove that they are of one user."""

from __future__ import annotations

import os
from pathlib import Path

from deodar.errors import HostsError, first_line
from deodar.model.written import STATES, states
from deodar.private_file import NotPrivate
from deodar.user_key import UserKey

HOSTS_KEY = "DEODAR_HOSTS_KEY"
"""Variable that names a file with the key, in place of the one in the folder of states."""


def hosts_key() -> UserKey:
    """Return the key of the hosts; it is made at its first use, unless a variable names its file.

    Raises:
        HostsError: others can read its file, it cannot be written, or it is missing or is not a key.
    """
    stated = os.environ.get(HOSTS_KEY, "")
    try:
        path = Path(stated) if stated else states() / "hosts" / "key"
    except RuntimeError:  # no home folder is known
        raise HostsError(
            "the key of the hosts has no place, because this user has no home folder",
            fix=f"State a folder in the variable {STATES}, or a file in {HOSTS_KEY}",
        ) from None
    try:
        return UserKey.at(path, new=not stated)
    except (OSError, ValueError) as error:
        raise HostsError(
            f"cannot be used as the key of the hosts: {first_line(error)}",
            where=str(path),
            fix=_advice(path, error, bool(stated)),
        ) from None


def _advice(path: Path, error: Exception, stated: bool) -> str:
    """Return what to do about an error of the file of the key."""
    if isinstance(error, NotPrivate) and error.command:
        return f"If it is the key of the hosts, type: {error.command}"
    if stated:
        return f"Copy the key of another host there, readable by you alone, or do not state {HOSTS_KEY}"
    if path.exists() and not isinstance(error, NotPrivate):
        return "Remove it; the next run makes another one"
    return f"State a folder that only you can change in the variable {STATES}"
