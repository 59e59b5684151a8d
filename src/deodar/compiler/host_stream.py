"""What JAX of one host and JAX of the first one send each other, as messages of their proven link.

The service of JAX that coordinates hosts asks no program for a proof. So it listens at a socket of its
machine, in a folder of this user alone, and has no port: what another host sends to a socket of its own
machine comes here through the link of the hosts.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Generator
from pathlib import Path

from deodar.compiler.proven_link import ProvenLink

RETRY = 0.02
"""Seconds between two attempts to reach JAX, which starts."""

PART = 2**16
"""Most bytes of a message."""


class HostStream:
    """The one connection of JAX between this host and another.

    Args:
        link: the link with the other host.
        mark: the first bytes of a message with bytes of JAX.
    """

    def __init__(self, link: ProvenLink, mark: bytes) -> None:
        self._link, self._mark = link, mark
        self._connection: socket.socket | None = None
        self._early = b""
        self._closed = False
        self._delivering = threading.Lock()

    def reach(self, path: Path, seconds: float) -> bool:
        """Connect with JAX of this host, which listens at a path soon; return whether that was possible."""
        until = time.monotonic() + seconds
        while time.monotonic() < until and not self._closed:
            connection = socket.socket(socket.AF_UNIX)
            with contextlib.suppress(OSError):
                connection.connect(str(path))
                connection.settimeout(None)
                self._connection = connection
                return True
            connection.close()
            time.sleep(RETRY)
        return False

    @contextlib.contextmanager
    def listening(self, path: Path, seconds: float) -> Generator[None]:
        """Let JAX of this host connect with a path while the context is open."""
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(str(path))
            server.listen(1)
            server.settimeout(seconds)
            threading.Thread(target=self._take, args=(server,), daemon=True, name="deodar-jax").start()
            yield

    def _take(self, server: socket.socket) -> None:
        with contextlib.suppress(OSError):
            connection, _ = server.accept()
            connection.setblocking(True)
            with self._delivering:
                connection.sendall(self._early)
                self._connection = connection
            self.run()

    def run(self) -> None:
        """Send the other host what JAX of this one says."""
        assert self._connection is not None
        with contextlib.suppress(OSError):
            while content := self._connection.recv(PART):
                self._link.send(self._mark + content)

    def deliver(self, content: bytes) -> None:
        """Give JAX of this host what that of the other one says."""
        with contextlib.suppress(OSError), self._delivering:
            if self._connection is None:
                self._early += content
            else:
                self._connection.sendall(content)

    def close(self) -> None:
        """End the connection: JAX finds that the other host has ended."""
        self._closed = True
        if self._connection is not None:
            with contextlib.suppress(OSError):
                self._connection.shutdown(socket.SHUT_RDWR)
