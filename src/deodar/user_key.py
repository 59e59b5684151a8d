"""A key of the user: a file that only this user can read, by which processes prove that they are of one user.

Any process of a machine can connect to its ports. A key answers challenges; it does not travel itself.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

from deodar import private_file

USER = "deodar"
"""The first part of the file of a key; the password follows."""

WRITING = 1.0
"""Seconds in which another process that makes a key must have written it."""


@dataclass(frozen=True)
class UserKey:
    """A key.

    Attributes:
        path: its file, `deodar:PASSWORD`, of mode 0600.
        password: the password, 192 random bits.
    """

    path: Path
    password: str = field(repr=False)

    @classmethod
    def at(cls, path: Path, new: bool = True) -> Self:
        """Return the key in a file, which is made at its first use if `new`.

        Raises:
            NotPrivate: others can access the file, or change its folder.
            OSError: it cannot be written, or there is none.
            ValueError: it is not a key.
        """
        if new and not path.exists():
            with contextlib.suppress(FileExistsError):
                private_file.write(path, f"{USER}:{private_file.new()}\n")
        return cls(path, _password(path))

    def proof(self, challenge: bytes) -> bytes:
        """Return what only a program with the key can answer to a challenge."""
        return hmac.digest(self.password.encode(), challenge, hashlib.sha256)

    def proven(self, challenge: bytes, proof: bytes) -> bool:
        """Return whether a proof answers a challenge."""
        return hmac.compare_digest(self.proof(challenge), proof)


def _password(path: Path) -> str:
    """Return the password in a file; another process may be about to write it."""
    limit = time.monotonic() + WRITING
    while not (text := private_file.read(path)) and time.monotonic() < limit:
        time.sleep(0.02)
    user, _, password = text.strip().partition(":")
    if user != USER or not private_file.FORM.match(password):
        raise ValueError(f"it does not hold {USER}: and a password")
    return password
