"""A link between two hosts that have proven to each other that they have one key.

The first host sends a nonce `b`; the other one its number `k`, a nonce `a` and the HMAC-SHA256 of both under
the key; the first one answers with an HMAC of its own. Nonces are new for each link, so that what was heard
on one proves nothing on another. Keys of the two directions follow from key, nonces and number, and each
message carries the HMAC of its content and its place in the order: who relays the bytes of a link can read
them, but cannot change, repeat or leave out a message.
"""

from __future__ import annotations

import contextlib
import hmac
import secrets
import socket
import struct
import threading
import time

from deodar.user_key import UserKey

MARK = b"deodar hosts 1\n"
"""What the first host sends first, with the version of this protocol."""

NONCE = 32
"""Bytes of a nonce."""

PROOF = 32
"""Bytes of a proof, and of what proves a message."""

REFUSED = bytes(PROOF)
"""Answer of the first host to a proof under another key."""

NUMBER = struct.Struct(">I")
"""Number of a host, and length of a message."""

COUNTER = struct.Struct(">Q")
"""Place of a message in the order of its direction."""

MOST = 2**28
"""Most bytes of a message."""


class OtherKey(Exception):
    """The other side does not have the key of this one.

    Attributes:
        host: the number that the other side states.
    """

    def __init__(self, host: int) -> None:
        super().__init__(f"host {host}")
        self.host = host


class ProvenLink:
    """A link whose messages prove that they are of the other side, and the next one.

    Args:
        link: the connection.
        sends: key of the messages that this side sends.
        receives: key of those that it receives.
    """

    def __init__(self, link: socket.socket, sends: bytes, receives: bytes) -> None:
        self._link, self._sends, self._receives = link, sends, receives
        self._sent = self._received = 0
        self._sending = threading.Lock()
        link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    @property
    def address(self) -> str:
        """The address of this machine at which the other side reaches it."""
        host = socket.getnameinfo(self._link.getsockname(), socket.NI_NUMERICHOST | socket.NI_NUMERICSERV)[0]
        return host.removeprefix("::ffff:")

    def send(self, message: bytes) -> None:
        """Send a message.

        Raises:
            OSError: the link has ended.
        """
        with self._sending:
            proof = _of(self._sends, COUNTER.pack(self._sent), message)
            self._sent += 1
            self._link.sendall(NUMBER.pack(len(message)) + proof + message)

    def receive(self, seconds: float | None = None) -> bytes:
        """Return the next message.

        Raises:
            OSError: the link has ended, the message does not come in time, or is not of the other side.
        """
        until = None if seconds is None else time.monotonic() + seconds
        head = _bytes(self._link, NUMBER.size + PROOF, until)
        length = NUMBER.unpack_from(head)[0]
        if length > MOST:
            raise ConnectionAbortedError("a message is too long")
        message = _bytes(self._link, length, until)
        proof = _of(self._receives, COUNTER.pack(self._received), message)
        if not hmac.compare_digest(proof, head[NUMBER.size :]):
            raise ConnectionAbortedError("a message is not of the other side, or not the next one")
        self._received += 1
        return message

    def ended(self) -> bool:
        """Return whether the other side, which says nothing meanwhile, has ended the link."""
        self._link.setblocking(False)
        try:
            return not self._link.recv(1, socket.MSG_PEEK)
        except BlockingIOError:
            return False
        except OSError:
            return True

    def close(self) -> None:
        """End the link, also in a thread that waits for a message."""
        with contextlib.suppress(OSError):
            self._link.shutdown(socket.SHUT_RDWR)
        self._link.close()


def to_first_host(link: socket.socket, key: UserKey, host: int, seconds: float) -> ProvenLink:
    """Return the link of host `host` with the first one, when both have proven their key.

    Raises:
        OtherKey: they have different keys.
        OSError: the other side is no first host, ends the link, or does not answer in time.
    """
    until = time.monotonic() + seconds
    opening = _bytes(link, len(MARK) + NONCE, until)
    if not opening.startswith(MARK):
        raise ConnectionAbortedError("what listens there is not a first host of this version")
    seen = opening + NUMBER.pack(host) + secrets.token_bytes(NONCE)
    link.sendall(seen[len(opening) :] + _proof(key, "other", seen))
    proof = _bytes(link, PROOF, until)
    if not key.proven(b"first host " + seen, proof):
        raise OtherKey(0)
    return ProvenLink(link, _proof(key, "to first", seen), _proof(key, "to other", seen))


def to_other_host(link: socket.socket, key: UserKey, seconds: float) -> tuple[int, ProvenLink]:
    """Return the number of a host that has connected, and the link with it, when both have proven their key.

    Raises:
        OtherKey: they have different keys.
        OSError: the other side ends the link, or does not prove its key in time.
    """
    until = time.monotonic() + seconds
    link.settimeout(seconds)
    opening = MARK + secrets.token_bytes(NONCE)
    link.sendall(opening)
    words = _bytes(link, NUMBER.size + NONCE + PROOF, until)
    host, seen, proof = NUMBER.unpack_from(words)[0], opening + words[:-PROOF], words[-PROOF:]
    if not key.proven(b"other host " + seen, proof):
        link.sendall(REFUSED)
        raise OtherKey(host)
    link.sendall(_proof(key, "first", seen))
    return host, ProvenLink(link, _proof(key, "to other", seen), _proof(key, "to first", seen))


def _proof(key: UserKey, subject: str, seen: bytes) -> bytes:
    """Return the HMAC of what both sides have seen; its subject says who proves what."""
    return key.proof(f"{subject} host ".encode() + seen)


def _of(key: bytes, counter: bytes, message: bytes) -> bytes:
    return hmac.digest(key, counter + message, "sha256")


def _bytes(link: socket.socket, count: int, until: float | None) -> bytes:
    """Return as many bytes of a link.

    Raises:
        OSError: it ends before, or they do not come in time.
    """
    read = bytearray()
    while len(read) < count:
        link.settimeout(None if until is None else max(0.001, until - time.monotonic()))
        if not (part := link.recv(min(count - len(read), 2**20))):
            raise ConnectionResetError("the other side has ended the link")
        read += part
    return bytes(read)
