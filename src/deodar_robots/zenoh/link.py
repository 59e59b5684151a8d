"""Connections over Zenoh: endpoints, TLS and its files, and sessions."""

from __future__ import annotations

import contextlib
import re
import socket
import ssl
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.codec import Json
from deodar.errors import Fix, MissingExtra, WorldError, option
from deodar_robots.zenoh import port_key
from deodar_robots.zenoh.port_key import RobotKey

_KEYS = "transport/link/tls/"


@dataclass(frozen=True)
class TlsFiles:
    """Files of one side of an encrypted connection, in PEM form.

    Attributes:
        authority: certificate of the authority that signed the certificate of the other side.
        certificate: certificate of this side.
        private_key: private key of that certificate, without a password.
    """

    authority: str = ""
    certificate: str = ""
    private_key: str = ""

    def __bool__(self) -> bool:
        return bool(self.authority or self.certificate or self.private_key)

    def to_data(self) -> dict[str, Json]:
        """Return the paths of the files that are stated."""
        paths: dict[str, Json] = {
            "authority": self.authority,
            "certificate": self.certificate,
            "private_key": self.private_key,
        }
        return {name: path for name, path in paths.items() if path}

    def of_server(self) -> dict[str, Json]:
        """Return the settings of Zenoh for the side that listens.

        Raises:
            WorldError: a file is missing, or is not one of TLS.
        """
        if not self.certificate or not self.private_key:
            raise WorldError(
                "a server with TLS needs a certificate and its private key",
                fix=Fix(
                    "State both: TlsFiles(certificate=..., private_key=...)",
                    "State both: --certificate robot.pem --key robot.key",
                ),
            )
        self.context()
        settings: dict[str, Json] = {
            f"{_KEYS}listen_certificate": self.certificate,
            f"{_KEYS}listen_private_key": self.private_key,
        }
        if self.authority:
            settings |= {f"{_KEYS}root_ca_certificate": self.authority, f"{_KEYS}enable_mtls": True}
        return settings

    def of_client(self) -> dict[str, Json]:
        """Return the settings of Zenoh for the side that connects.

        Raises:
            WorldError: a file is missing, or is not one of TLS.
        """
        if not self.authority:
            raise WorldError(
                "a connection with TLS needs the authority that signed the certificate of the robot",
                fix='State it: authority="authority.pem"',
            )
        self.context()
        settings: dict[str, Json] = {
            f"{_KEYS}root_ca_certificate": self.authority,
            f"{_KEYS}verify_name_on_connect": True,
        }
        if self.certificate:
            settings |= {
                f"{_KEYS}connect_certificate": self.certificate,
                f"{_KEYS}connect_private_key": self.private_key,
                f"{_KEYS}enable_mtls": True,
            }
        return settings

    def context(self) -> ssl.SSLContext:
        """Return a context of Python's TLS with these files.

        Raises:
            WorldError: a file is missing, or is not one of TLS.
        """
        for name, path in self.to_data().items():
            if not Path(str(path)).is_file():
                raise WorldError(f"there is no such file of the {name.replace('_', ' ')}", where=str(path))
        if bool(self.certificate) != bool(self.private_key):
            lacks = "certificate" if self.private_key else "private key"
            raise WorldError(f"of a certificate and its private key, the {lacks} is not stated")
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        try:
            if self.authority:
                context.load_verify_locations(cafile=self.authority)
        except (ssl.SSLError, OSError):
            raise WorldError("holds no certificate in PEM form", where=self.authority) from None
        try:
            if self.certificate:
                context.load_cert_chain(self.certificate, self.private_key, password=lambda: b"")
        except (ssl.SSLError, OSError) as error:
            mismatch = isinstance(error, ssl.SSLError) and error.reason == "KEY_VALUES_MISMATCH"
            fault = (
                "is not the private key of" if mismatch else "is not a private key without a password, for"
            )
            raise WorldError(f"{fault} a certificate in {self.certificate}", where=self.private_key) from None
        return context


def why_not(scheme: str, host: str, port: int, files: TlsFiles, seconds: float) -> tuple[str, str]:
    """Return why a connection did not come about, and what to type; both "" if the peer does not say so."""
    place = f"{host}:{port}"
    plain = f"{place} does not encrypt what it sends", f"Serve it with --at tls/{place} --certificate ..."
    try:
        if scheme == "tls":
            return ("", "") if _handshake(files.context(), host, port, seconds) else plain
        if _handshake(_any(), host, port, seconds):
            return f"{place} encrypts what it sends", f'Write at="tls/{place}" and authority="..."'
    except ssl.SSLCertVerificationError as error:
        reason = error.verify_message
        if "mismatch" in reason or "not valid for" in reason:
            fix = "Write the host as the certificate names it, or make a certificate for this name"
            return f"the certificate at {place} is for another name", fix
        if "expired" in reason or "not yet valid" in reason:
            return f"the certificate at {place} has expired or is not valid yet", "Make a new one"
        fix = "State the authority that signed the certificate of the robot"
        return f"the certificate at {place} is not signed by {files.authority}", fix
    except ssl.SSLError as error:
        if "ALERT" in (error.reason or "") and "CERT" in (error.reason or ""):
            return f"{place} asks for a certificate", "State both: certificate=... and private_key=..."
        if "ALERT" in (error.reason or ""):
            return f"{place} does not accept the certificate {files.certificate}", "Let its authority sign it"
        return plain if scheme == "tls" else ("", "")
    except OSError:
        pass
    return "", ""


def _any() -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def _handshake(context: ssl.SSLContext, host: str, port: int, seconds: float) -> bool:
    """Return whether the peer uses TLS; wait for its word on the certificate of this side."""
    bare = host.strip("[]")
    with socket.create_connection((bare, port), timeout=seconds) as plain:
        try:
            peer = context.wrap_socket(plain, server_hostname=bare)
        except TimeoutError:
            return False
        with contextlib.suppress(TimeoutError), peer:
            peer.recv(1)
    return True


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
        trusted: whether the network of another host, or every process of this one, is trusted; without TLS
            messages are not encrypted.
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


Credentials = TlsFiles | RobotKey
"""What a side proves itself with: certificates, or the key of a port of this machine."""


def credentials(endpoint: str, trusted: bool = False, files: TlsFiles = NO_FILES) -> Credentials:
    """Return what a side at an endpoint proves itself with; without TLS and the key of a port, nothing.

    Raises:
        WorldError: the key of the port cannot be read or made.
    """
    scheme, host, _ = _parts(endpoint)
    return files if scheme == "tls" or trusted or host not in LOCAL else key_of(endpoint)


def key_of(endpoint: str) -> RobotKey:
    """Return the key of a port of this machine; it is made at its first use.

    Raises:
        WorldError: the text is not an endpoint of this machine without TLS, or the key cannot be read or
            made.
    """
    match = _ENDPOINT.fullmatch(require_endpoint(endpoint))
    if match is None or match[1] == "tls":
        raise WorldError(f"{endpoint} proves itself by certificates", fix=f"Write it as {HERE}")
    return port_key.key_at(match[2], int(match[3]))


def connect(endpoint: str, patience: float, credentials: Credentials = NO_FILES, router: bool = False) -> Any:
    """Return a session of Zenoh that is connected to an endpoint and listens nowhere.

    Args:
        endpoint: the endpoint.
        patience: time after which a program that does not answer is given up, s.
        credentials: certificates, for an endpoint with TLS, or the key of the port.
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
            "connect/endpoints": [_numbered(endpoint)],
            # the rest is for the question why not
            "connect/timeout_ms": max(1, round(800 * patience)),
            "connect/exit_on_failure": True,
            **_proven(scheme, credentials, credentials.of_client),
        }
    )
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        key = isinstance(credentials, RobotKey)
        files = NO_FILES if key else credentials
        fault, fix = why_not(scheme, host, port, files, max(0.1, 0.1 * patience))
        who, start = "robot", "Start the robot as this user, for example: deodar serve arena:blocks"
        if router:
            who, start = "router of ROS 2", "Start it: ros2 run rmw_zenoh_cpp rmw_zenohd"
        proof = f" with the key of this port, {credentials.path}" if key else ""
        raise WorldError(
            fault or f"no {who} answers at {endpoint} within {patience:g} s{proof}",
            where=endpoint if fault else "",
            fix=fix or start,
        ) from None


def listen(endpoint: str, credentials: Credentials = NO_FILES, router: bool = False) -> Any:
    """Return a session of Zenoh that listens at an endpoint, and nowhere else.

    Args:
        endpoint: the endpoint.
        credentials: certificates, for an endpoint with TLS, or the key of the port.
        router: whether messages between others go through this session.

    Raises:
        WorldError: the endpoint is taken, or is not one of this machine; or the certificates do not fit.
    """
    zenoh = library()
    scheme, host, _ = _parts(endpoint)
    secure = _proven(scheme, credentials, credentials.of_server)
    try:
        mode = "router" if router else "peer"
        return zenoh.open(_config({"mode": mode, "listen/endpoints": [_numbered(endpoint)], **secure}))
    except zenoh.ZError as error:
        taken = "in use" in str(error)
        raise WorldError(
            f"cannot listen at {endpoint}{': another program does' if taken else ''}",
            fix=option("Choose another port:", "at", f"{scheme}/{host}:7462"),
        ) from None


def _proven(
    scheme: str, credentials: Credentials, settings: Callable[[], dict[str, Json]]
) -> dict[str, Json]:
    """Return settings of Zenoh for credentials; none where there is nothing to prove."""
    return settings() if scheme == "tls" or isinstance(credentials, RobotKey) else {}


def _numbered(endpoint: str) -> str:
    """Return an endpoint with the address of this machine in place of its name, which may stand for two."""
    return endpoint.replace("/localhost:", "/127.0.0.1:")


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
