"""Why a camera at an address sends no picture, as far as its first answer says so."""

from __future__ import annotations

import re
import socket
import ssl
from dataclasses import dataclass
from http import HTTPStatus
from urllib.parse import urlsplit

from deodar.credentials import HIDDEN
from deodar.worlds._address import Address

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
