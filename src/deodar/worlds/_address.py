"""Addresses of cameras."""

from __future__ import annotations

import netrc
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import quote, urlsplit

from deodar.credentials import HIDDEN, masked
from deodar.errors import WorldError

PORTS = {"rtsp": 554, "http": 80, "https": 443}
"""Schemes of addresses, with their usual ports."""

_ADDRESS = re.compile(rf"({'|'.join(PORTS)})://", re.IGNORECASE)


def is_address(text: str) -> bool:
    """Return whether a text begins as an address of a camera does: rtsp://, http:// or https://."""
    return _ADDRESS.match(text) is not None


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
        displayed = masked(text)
        where = f"camera {displayed}"
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
            fault = "the address of a camera has no host, or characters that an address cannot have"
            fix = "Write rtsp://HOST:PORT/PATH, and %40 for @ in a password, %2F for /"
            raise WorldError(fault, where=masked(text.split()[0]) if text.split() else "", fix=fix) from None
        user, at, place = parts.netloc.rpartition("@")
        if user == HIDDEN:
            user = _login(host, where)
        if HIDDEN in parts.query or HIDDEN in parts.path:
            fix = "Name the camera again, with the whole address"
            raise WorldError("the address was stored without its secrets", where=where, fix=fix)
        full = parts._replace(netloc=f"{user}{at}{place}").geturl()
        return cls(displayed, parts.scheme, host, port, full, bool(at))


def _login(host: str, where: str) -> str:
    """Return USER:PASSWORD of a host from the file .netrc."""
    file = Path(os.environ.get("NETRC") or Path.home() / ".netrc")
    fix = f"Add a line to it: machine {host} login USER password PASSWORD"
    try:
        hosts = netrc.netrc(str(file)).hosts if file.is_file() else {}
    except (OSError, netrc.NetrcParseError) as error:
        why = error.msg if isinstance(error, netrc.NetrcParseError) else str(error.strerror)
        raise WorldError(f"{file} cannot be read: {why}", where=where) from None
    login = hosts.get(host)
    if login is None:
        raise WorldError(f"{file} states no login for {host}", where=where, fix=fix)
    return f"{quote(login[0], safe='')}:{quote(login[2], safe='')}"
