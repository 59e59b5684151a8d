"""The connection of two peers by Zenoh: endpoints are stated, and nothing is searched for."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from deodar import codec
from deodar.errors import MissingExtra, WorldError

HERE = "tcp/127.0.0.1:7461"
"""Endpoint of a robot that states none: this machine alone."""

LOCAL = ("127.0.0.1", "localhost", "[::1]")
_ENDPOINT = re.compile(r"tcp/(\[[0-9a-fA-F:.]+\]|[\w.-]+):(\d{1,5})")


def library() -> Any:
    """Import Zenoh (extra `network`), or raise an error that says how to install it."""
    try:
        # an extra
        import zenoh
    except ImportError:
        raise MissingExtra("eclipse-zenoh", "network", "a robot on the network") from None
    return zenoh


def require_endpoint(text: str, trusted: bool = False) -> str:
    """Return an endpoint such as tcp/127.0.0.1:7461.

    Args:
        text: the endpoint.
        trusted: whether the network of another host is trusted; messages are not encrypted.

    Raises:
        WorldError: the text is not an endpoint, or it leads to another host without trust.
    """
    found = _ENDPOINT.fullmatch(text)
    if found is None or int(found[2]) > 65535:
        raise WorldError(f"{text!r} is not an endpoint", fix=f"Write it as {HERE}")
    if found[1] not in LOCAL and not trusted:
        raise WorldError(
            f"{text} leads beyond this machine, without encryption",
            fix="In a network of your own state it: trusted=True, for the server --trusted",
        )
    return text


def connect(endpoint: str, patience: float, router: bool = False) -> Any:
    """Return a session of Zenoh that is connected to an endpoint and listens nowhere.

    Args:
        endpoint: the endpoint.
        patience: time after which a program that does not answer is given up, s.
        router: whether a router of ROS 2 listens there, through which all messages go, or the robot itself.

    Raises:
        WorldError: no program listens there within `patience` seconds.
    """
    zenoh = library()
    config = _config(
        {
            "mode": "client" if router else "peer",
            "listen/endpoints": [],
            "connect/endpoints": [endpoint],
            "connect/timeout_ms": max(1, round(1000 * patience)),
            "connect/exit_on_failure": True,
        }
    )
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        who, start = ("robot", "Start the robot, for example: deodar serve arena:blocks")
        if router:
            who, start = "router of ROS 2", "Start it: ros2 run rmw_zenoh_cpp rmw_zenohd"
        raise WorldError(f"no {who} answers at {endpoint} within {patience:g} s", fix=start) from None


def listen(endpoint: str, router: bool = False) -> Any:
    """Return a session of Zenoh that listens at an endpoint, and nowhere else.

    Args:
        endpoint: the endpoint.
        router: whether messages between others go through this session.

    Raises:
        WorldError: the endpoint is taken, or is not one of this machine.
    """
    zenoh = library()
    try:
        mode = "router" if router else "peer"
        return zenoh.open(_config({"mode": mode, "listen/endpoints": [endpoint]}))
    except zenoh.ZError as error:
        taken = "in use" in str(error)
        raise WorldError(
            f"cannot listen at {endpoint}{': another program does' if taken else ''}",
            fix="Choose another port: --at tcp/127.0.0.1:7462",
        ) from None


def callback(take: Callable[[Any], None], end: Callable[[], None] | None = None) -> Any:
    """Return a handler that calls `take` with each message, in order, and `end` after the last one.

    Both are called in a thread of Zenoh and must not wait.
    """
    return library().handlers.Callback(take, end, indirect=False)


def _config(settings: dict[str, Any]) -> Any:
    config = library().Config()
    quiet = {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "adminspace/enabled": False,
    }
    for key, value in (quiet | settings).items():
        config.insert_json5(key, codec.line(value))
    return config
