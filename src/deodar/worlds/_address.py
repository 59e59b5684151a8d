"""Addresses of cameras and robots: their form, and whether they can be reached."""

from __future__ import annotations

import netrc
import os
import re
import socket
import ssl
from dataclasses import dataclass, field
from http import HTTPStatus
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


_STATUS = re.compile(rb"(?:HTTP|RTSP)/\d\.\d (\d{3})\b")


@dataclass(frozen=True)
class Unreachable:
    """Why a camera sends no picture.

    Attributes:
        what: the reason.
        fix: what to type.
    """

    what: str
    fix: str


def unreachable(address: Address, seconds: float) -> Unreachable | None:
    """Ask the peer of an address once, without credentials; None: its answer does not say what is wrong."""
    peer = f"{address.host}:{address.port}"
    try:
        with socket.create_connection((address.host, address.port), timeout=seconds) as plain:
            status = _status(address, plain)
    except socket.gaierror:
        return Unreachable(f"there is no host {address.host}", "Check the name, or write its number")
    except ConnectionRefusedError:
        return Unreachable(f"{peer} refuses the connection", "Check the port, and that the camera serves it")
    except TimeoutError:
        return Unreachable(f"{peer} does not answer", "Check the address, and that the camera is on")
    except OSError as error:
        return Unreachable(f"{peer} cannot be reached: {error.strerror or error}", "Check the network")
    if status in (401, 403):
        address_to_write = f"{address.scheme}://{HIDDEN}@{peer}/..."
        line = f"machine {address.host} login USER password PASSWORD"
        fault = "refuses the user and password" if address.login else "asks for a user and password"
        return Unreachable(fault, f"Write {address_to_write}, and into the file ~/.netrc: {line}")
    if status is not None and status >= 300:
        names = {int(status_code): f", {status_code.phrase}" for status_code in HTTPStatus}
        return Unreachable(f"{peer} answers {status}{names.get(status, '')}", "Check the path of the address")
    return None


def _status(address: Address, plain: socket.socket) -> int | None:
    """Return the status of the first answer; None: there is none."""
    parts = urlsplit(address.full)
    place = f"{address.host}:{address.port}"
    path = f"{parts.path or '/'}{f'?{parts.query}' if parts.query else ''}"
    if address.scheme == "rtsp":
        request = f"DESCRIBE rtsp://{place}{path} RTSP/1.0\r\nCSeq: 1\r\n\r\n"
    else:
        request = f"GET {path} HTTP/1.0\r\nHost: {place}\r\n\r\n"
    try:
        peer = plain
        if address.scheme == "https":
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            peer = context.wrap_socket(plain, server_hostname=address.host)
        peer.sendall(request.encode())
        match = _STATUS.match(peer.recv(64))
    except OSError:
        return None
    return int(match[1]) if match else None
