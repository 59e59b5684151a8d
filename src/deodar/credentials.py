"""Credentials in addresses, which no message and no file shows."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from urllib.parse import unquote

from deodar.codec import Json

HIDDEN = "***"
"""What messages and records show instead of credentials."""

_URL = re.compile(r"([a-zA-Z][\w+.-]*://)([^\s\"']*)")
_SECRET = re.compile(
    r"([?&;#/_][^=&?/\s]*(?:token|pass|pw|key|secret|auth|sig|cred|sess|code|login)[^=&?/\s]*=)([^&\s\"']+)",
    re.IGNORECASE,
)


def masked(text: str) -> str:
    """Return a text in which the credentials of every address are `***`.

    These are the user and the password of an address, and the values of parameters whose names say so, such
    as `token`, `password` and `key`.
    """
    return _URL.sub(lambda found: found[1] + _masked_rest(found[2]), text)


def masked_data(data: Json) -> Json:
    """Return plain data in which the credentials of every address are `***`."""
    if isinstance(data, str):
        return masked(data)
    if isinstance(data, list):
        return [masked_data(each) for each in data]
    return {key: masked_data(each) for key, each in data.items()} if isinstance(data, dict) else data


def secrets(text: str) -> list[str]:
    """Return what `masked` hides in a text, also decoded, and passwords by themselves; the longest first."""
    found: list[str] = []
    for address in _URL.finditer(text):
        login = _login(address[2])
        found += [login, *login.split(":", 1)[1:]]
        found += [match[2] for match in _SECRET.finditer(address[2])]
    return sorted({*found, *map(unquote, found)} - {""}, key=len, reverse=True)


def _masked_rest(rest: str) -> str:
    """Return what follows :// without credentials."""
    login = _login(rest)
    rest = f"{HIDDEN}{rest[len(login) :]}" if login else rest
    return _SECRET.sub(rf"\g<1>{HIDDEN}", rest)


def _login(rest: str) -> str:
    """Return the user and password of what follows ://; empty: there are none."""
    authority = re.split(r"[/?#]", rest, maxsplit=1)[0]
    login, at, _ = authority.rpartition("@")
    if at:
        return login
    if "@" in rest and re.search(r":(?!\d+$)", authority.rpartition("]")[2]):
        return rest.rpartition("@")[0]  # a password that contains a slash
    return ""


@dataclass(frozen=True)
class Hidden:
    """A value that `repr` does not show.

    Attributes:
        value: the value.
    """

    value: int | str = field(repr=False)
