"""The connection of two peers by Zenoh: endpoints are stated, and nothing is searched for."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from deodar import codec
from deodar.errors import MissingExtra, WorldError, option
from deodar_robots.zenoh.tls_files import TlsFiles, why_not

HERE = "tcp/127.0.0.1:7461"
"""Endpoint of a robot that states none: this machine alone."""

NO_FILES = TlsFiles()
"""No certificates: messages are not encrypted."""

LOCAL = ("127.0.0.1", "localhost", "[::1]")
_ENDPOINT = re.compile(r"(tcp|tls)/(\[[0-9a-fA-F:.]+\]|[\w.-]+):(\d{1,5})")


def library() -> Any:
    """Import Zenoh (extra `network`), or raise an error that says how to install it."""
    try:
        # an extra
        import zenoh
    except ImportError:
        raise MissingExtra("eclipse-zenoh", "network", "a robot on the network") from None
    return zenoh


def require_endpoint(text: str, trusted: bool = False, files: TlsFiles = NO_FILES) -> str:
    """Return an endpoint such as tcp/127.0.0.1:7461 or tls/robot.lab:7461.

    Args:
        text: the endpoint.
        trusted: whether the network of another host is trusted; without TLS messages are not encrypted.
        files: certificates.

    Raises:
        WorldError: the text is not an endpoint, it leads to another host without encryption or trust, or
            certificates are stated for an endpoint without TLS.
    """
    match = _ENDPOINT.fullmatch(text)
    if match is None or int(match[3]) > 65535:
        raise WorldError(f"{text!r} is not an endpoint", fix=f"Write it as {HERE}, or tls/HOST:PORT")
    if match[1] == "tls":
        return text
    place = f"{match[2]}:{match[3]}"
    if files:
        raise WorldError(f"{text} uses no certificates", fix=f"Write tls/{place}")
    if match[2] not in LOCAL and not trusted:
        raise WorldError(
            f"{text} leads beyond this machine, without encryption",
            fix=option(
                f"Write tls/{place} and state certificates; in your own network state that you trust it:",
                "trusted",
                "",
                "True",
            ),
        )
    return text


def connect(endpoint: str, patience: float, files: TlsFiles = NO_FILES, router: bool = False) -> Any:
    """Return a session of Zenoh that is connected to an endpoint and listens nowhere.

    Args:
        endpoint: the endpoint.
        patience: time after which a program that does not answer is given up, s.
        files: certificates, for an endpoint with TLS.
        router: whether a router of ROS 2 listens there, through which all messages go, or the robot itself.

    Raises:
        WorldError: no program listens there within `patience` seconds, or the certificates do not fit.
    """
    zenoh = library()
    scheme, host, port = _parts(endpoint)
    config = _config(
        {
            "mode": "client" if router else "peer",
            "listen/endpoints": [],
            "connect/endpoints": [endpoint],
            # the rest is for the question why not
            "connect/timeout_ms": max(1, round(800 * patience)),
            "connect/exit_on_failure": True,
            **(files.of_client() if scheme == "tls" else {}),
        }
    )
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        fault, fix = why_not(scheme, host, port, files, max(0.1, 0.1 * patience))
        who, start = "robot", "Start the robot, for example: deodar serve arena:blocks"
        if router:
            who, start = "router of ROS 2", "Start it: ros2 run rmw_zenoh_cpp rmw_zenohd"
        raise WorldError(
            fault or f"no {who} answers at {endpoint} within {patience:g} s",
            where=endpoint if fault else "",
            fix=fix or start,
        ) from None


def listen(endpoint: str, files: TlsFiles = NO_FILES, router: bool = False) -> Any:
    """Return a session of Zenoh that listens at an endpoint, and nowhere else.

    Args:
        endpoint: the endpoint.
        files: certificates, for an endpoint with TLS.
        router: whether messages between others go through this session.

    Raises:
        WorldError: the endpoint is taken, or is not one of this machine; or the certificates do not fit.
    """
    zenoh = library()
    scheme, host, _ = _parts(endpoint)
    secure = files.of_server() if scheme == "tls" else {}
    try:
        mode = "router" if router else "peer"
        return zenoh.open(_config({"mode": mode, "listen/endpoints": [endpoint], **secure}))
    except zenoh.ZError as error:
        taken = "in use" in str(error)
        raise WorldError(
            f"cannot listen at {endpoint}{': another program does' if taken else ''}",
            fix=option("Choose another port:", "at", f"{scheme}/{host}:7462"),
        ) from None


def _parts(endpoint: str) -> tuple[str, str, int]:
    """Return scheme, host and port."""
    match = _ENDPOINT.fullmatch(endpoint)
    assert match is not None, "the endpoint was checked before"
    return match[1], match[2], int(match[3])


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
