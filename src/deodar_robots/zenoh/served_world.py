"""A world that a thread of this process serves, for examples and tests."""

from __future__ import annotations

import socket
import threading

from deodar.worlds._base import World
from deodar_robots.zenoh import link
from deodar_robots.zenoh.about import RobotClock
from deodar_robots.zenoh.link import TlsFiles
from deodar_robots.zenoh.server import WorldServer


class ServedWorld:
    """A server in a thread of its own.

    Args:
        world: the world.
        name: name of the robot.
        clock: step, or live.
        at: endpoint; empty: a free port of this machine.
        files: certificates for an endpoint with TLS.
        trusted: whether every process of this machine is.

    Attributes:
        server: the server.
        endpoint: where it listens.
    """

    def __init__(
        self,
        world: World,
        name: str = "example",
        clock: RobotClock = "step",
        at: str = "",
        files: TlsFiles = link.NO_FILES,
        trusted: bool = False,
    ) -> None:
        self.endpoint = at or free_endpoint()
        self.server = WorldServer(world, name, self.endpoint, clock, trusted, files)
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._serve, name=f"serve {name}", daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        try:
            self.server.serve(self._stopped.is_set)
        finally:
            self.server.close()

    def close(self) -> None:
        """Stop the server and wait until it has left the network."""
        self._stopped.set()
        self._thread.join()


def free_endpoint(scheme: str = "tcp") -> str:
    """Return an endpoint of this machine at a port that is free now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"{scheme}/127.0.0.1:{probe.getsockname()[1]}"
