"""Bytes that carry their proof: a mark, their length and their SHA-256 stand behind the content.

Compiled programs and stored states are checked before anything in them is parsed, unpickled or loaded. Behind
the content, a seal leaves an .npz file one that NumPy reads. It finds damage, not intent: who can write the
file can write another seal.
"""

from __future__ import annotations

import hashlib
import struct

import google_crc32c

from deodar.errors import DamagedFile

MARK = b"\ndeodar sealed 1\n"
LENGTH = struct.Struct("<Q")
SIZE = len(MARK) + LENGTH.size + hashlib.sha256().digest_size
"""Number of bytes of a seal."""


def checksum(content: bytes) -> str:
    """Return the CRC-32C of bytes, as eight hexadecimal digits."""
    return f"{google_crc32c.value(content):08x}"


def seal(content: bytes) -> bytes:
    """Return the content, and behind it its seal."""
    return content + MARK + LENGTH.pack(len(content)) + hashlib.sha256(content).digest()


def is_sealed(content: bytes) -> bool:
    """Return whether bytes end in a seal; those of earlier versions do not."""
    return len(content) >= SIZE and content.startswith(MARK, len(content) - SIZE)


def unseal(content: bytes) -> memoryview:
    """Return the content without its seal, and without copying it.

    Raises:
        DamagedFile: the bytes are not those that `seal` returned.
    """
    inner, proof = memoryview(content)[:-SIZE], memoryview(content)[-SIZE + len(MARK) :]
    if not is_sealed(content) or LENGTH.unpack(proof[: LENGTH.size])[0] != len(inner):
        raise DamagedFile("it was cut, or has no seal")
    if hashlib.sha256(inner).digest() != bytes(proof[LENGTH.size :]):
        raise DamagedFile("its SHA-256 is that of another content")
    return inner
