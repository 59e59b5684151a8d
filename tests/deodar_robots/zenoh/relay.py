"""A relay between two programs, which tests read, or cut."""

from __future__ import annotations

import socket
import threading


class Relay:
    """A relay of connections to an endpoint.

    Attributes:
        seen: all bytes that passed.
        port: port of this machine at which it listens.
        passing: whether bytes pass; while it is not set they wait, as in a network that is cut, and both
            connections stay.
    """

    def __init__(self, to: str) -> None:
        self.seen = bytearray()
        host, _, port = to.partition("/")[2].rpartition(":")
        self._to = (host, int(port))
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listening.getsockname()[1])
        self._ends: list[socket.socket] = []
        self.passing = threading.Event()
        self.passing.set()
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        try:
            while True:
                one, _ = self._listening.accept()
                other = socket.create_connection(self._to)
                self._ends += [one, other]
                for ends in ((one, other), (other, one)):
                    threading.Thread(target=self._pass, args=ends, daemon=True).start()
        except OSError:
            return

    def _pass(self, source: socket.socket, target: socket.socket) -> None:
        try:
            while data := source.recv(65536):
                self.passing.wait()
                self.seen += data
                target.sendall(data)
        except OSError:
            return

    def close(self) -> None:
        """Close all connections."""
        for each in (self._listening, *self._ends):
            each.close()
        self.passing.set()
