"""Addresses of cameras, and their credentials, which no message and no record shows."""

from __future__ import annotations

import netrc
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import quote, urlsplit

from deodar.codec import Json
from deodar.errors import WorldError

PORTS = {"rtsp": 554, "http": 80, "https": 443}
"""Schemes of addresses, with their usual ports."""

HIDDEN = "***"
"""What messages and records show instead of credentials."""

_ADDRESS = re.compile(rf"({'|'.join(PORTS)})://", re.IGNORECASE)
_URL = re.compile(r"([a-zA-Z][\w+.-]*://)([^\s\"']*)")
_SECRET = re.compile(
    r"([?&;#/_][^=&?/\s]*(?:token|pass|pw|key|secret|auth|sig|cred|sess|code|login)[^=&?/\s]*=)[^&\s\"']+",
    re.IGNORECASE,
)


def is_address(text: str) -> bool:
    """Return whether a text begins as an address of a camera does: rtsp://, http:// or https://."""
    return _ADDRESS.match(text) is not None


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


def _masked_rest(rest: str) -> str:
    """Return what follows :// without credentials."""
    authority = re.split(r"[/?#]", rest, maxsplit=1)[0]
    _, at, host = authority.rpartition("@")
    if at:
        rest = f"{HIDDEN}@{host}{rest[len(authority) :]}"
    elif "@" in rest and re.search(r":(?!\d+$)", authority.rpartition("]")[2]):
        rest = f"{HIDDEN}@{rest.rpartition('@')[2]}"  # a password that contains a slash
    return _SECRET.sub(rf"\g<1>{HIDDEN}", rest)


@dataclass(frozen=True)
class Hidden:
    """A value that `repr` does not show.

    Attributes:
        value: the value.
    """

    value: int | str = field(repr=False)


@dataclass(frozen=True)
class Address:
    """The address of a camera.

    Attributes:
        shown: the address without credentials, for messages and records.
        scheme, host, port: its parts.
        full: the address with credentials; only the camera receives it.
        login: whether it has a user and password.
    """

    shown: str
    scheme: str
    host: str
    port: int
    full: str = field(repr=False)
    login: bool

    @classmethod
    def of(cls, text: str) -> Address:
        """Read an address. A user of `***` stands for the login that the file .netrc states for the host.

        Raises:
            WorldError: the text is not an address, or hides credentials that nothing else states.
        """
        shown = masked(text)
        where = f"camera {shown}"
        if not is_address(text):
            fix = f"Write {', '.join(f'{scheme}://' for scheme in PORTS)} or the path of a file"
            raise WorldError("is not an address of a camera", where=where, fix=fix)
        try:
            if re.search(r"[\s\x00-\x1f\"']", text):
                raise ValueError
            parts = urlsplit(text)
            host, port = parts.hostname or "", parts.port or PORTS[parts.scheme]
            if not host:
                raise ValueError
        except ValueError:
            what = "the address of a camera has no host, or characters that an address cannot have"
            fix = "Write rtsp://HOST:PORT/PATH, and %40 for @ in a password, %2F for /"
            raise WorldError(what, where=masked(text.split()[0]) if text.split() else "", fix=fix) from None
        user, at, place = parts.netloc.rpartition("@")
        if user == HIDDEN:
            user = _login(host, where)
        if HIDDEN in parts.query or HIDDEN in parts.path:
            fix = "Name the camera again, with the whole address"
            raise WorldError("the address was stored without its secrets", where=where, fix=fix)
        full = parts._replace(netloc=f"{user}{at}{place}").geturl()
        return cls(shown, parts.scheme, host, port, full, bool(at))


def _login(host: str, where: str) -> str:
    """Return USER:PASSWORD of a host from the file .netrc."""
    file = Path(os.environ.get("NETRC") or Path.home() / ".netrc")
    fix = f"Add a line to it: machine {host} login USER password PASSWORD"
    try:
        known = netrc.netrc(str(file)).hosts if file.is_file() else {}
    except (OSError, netrc.NetrcParseError) as error:
        why = error.msg if isinstance(error, netrc.NetrcParseError) else str(error.strerror)
        raise WorldError(f"{file} cannot be read: {why}", where=where) from None
    found = known.get(host)
    if found is None:
        raise WorldError(f"{file} states no login for {host}", where=where, fix=fix)
    return f"{quote(found[0], safe='')}:{quote(found[2], safe='')}"
