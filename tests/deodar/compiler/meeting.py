"""Ports and connections of tests in which hosts meet."""

from __future__ import annotations

import contextlib
import socket
import time


def free_port() -> str:
    """Return the number of a port that is free."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return str(server.getsockname()[1])


def reached(address: str) -> socket.socket:
    """Return a connection to a port that is opened meanwhile."""
    host, _, port = address.partition(":")
    while True:
        with contextlib.suppress(ConnectionRefusedError):
            return socket.create_connection((host, int(port)), 5.0)
        time.sleep(0.01)


def until_end(link: socket.socket) -> bytes:
    """Return all that comes until the other side ends the connection."""
    heard = b""
    with contextlib.suppress(ConnectionResetError):
        while part := link.recv(1000):
            heard += part
    return heard
