"""The key of a port of this machine, by which a robot and its model prove that they are of one user.

Any process of the machine can connect to a port. Zenoh opens a link only to a side that knows the password of
the key; the password itself does not travel. A model asks the robot for a proof in turn, so that a program
that took the port cannot show readings. Each port has a key of its own: what is answered to a program at one
port opens no other one.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from deodar.codec import Json
from deodar.errors import WorldError, first_line
from deodar.model.written import STATES, states
from deodar.private_file import NotPrivate
from deodar.user_key import USER, UserKey

_AUTH = "transport/auth/usrpwd/"


@dataclass(frozen=True)
class RobotKey(UserKey):
    """The key of a port, whose file Zenoh reads as a dictionary of users."""

    def of_server(self) -> dict[str, Json]:
        """Return the settings of Zenoh for the side that listens."""
        return {f"{_AUTH}dictionary_file": str(self.path)}

    def of_client(self) -> dict[str, Json]:
        """Return the settings of Zenoh for the side that connects."""
        return {f"{_AUTH}user": USER, f"{_AUTH}password": self.password}


def path_of(host: str, port: int) -> Path:
    """Return the path of the key of a port."""
    return states() / "robots" / (f"{port}-v6" if ":" in host else f"{port}")


def key_at(host: str, port: int) -> RobotKey:
    """Return the key of a port; it is made at its first use.

    Raises:
        WorldError: others can read its file, or it cannot be written, or is not a key.
    """
    try:
        path = path_of(host, port)
    except RuntimeError:  # no home folder is known
        raise WorldError(
            "the key of a port has no place, because this user has no home folder",
            fix=f"State a folder in the variable {STATES}",
        ) from None
    try:
        return RobotKey.at(path)
    except (OSError, ValueError) as error:
        if isinstance(error, NotPrivate) and error.command:
            fix = f"If it is the key of this port, type: {error.command}"
        elif path.exists():
            fix = "Remove it; the next robot at this port makes another one"
        else:
            fix = f"State a folder that you can write in the variable {STATES}"
        raise WorldError(
            f"cannot be used as the key of a port: {first_line(error)}", where=str(path), fix=fix
        ) from None
