"""Certificates with which two peers encrypt what they send, and recognise each other."""

from __future__ import annotations

import contextlib
import socket
import ssl
from dataclasses import dataclass
from pathlib import Path

from deodar.codec import Json
from deodar.errors import Fix, WorldError

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
