"""Bytes that carry their proof: length and SHA-256 stand in front of the content.

Compiled programs and stored states are checked before anything in them is parsed, unpickled or loaded. A
seal finds damage, not intent: who can write the file can write another seal.
"""

from __future__ import annotations

import hashlib
import struct

from deodar.errors import DamagedFile

MARK = b"deodar sealed 1\n"
LENGTH = struct.Struct("<Q")
SIZE = len(MARK) + LENGTH.size + hashlib.sha256().digest_size
"""Number of bytes in front of the content."""


def seal(content: bytes) -> bytes:
    """Return the content behind its mark, its length and the SHA-256 of both."""
    length = LENGTH.pack(len(content))
    return MARK + length + hashlib.sha256(length + content).digest() + content


def is_sealed(content: bytes) -> bool:
    """Return whether bytes begin with the mark; bytes of earlier versions do not."""
    return content.startswith(MARK)


def unseal(content: bytes) -> memoryview:
    """Return the content, without copying it.

    Raises:
        DamagedFile: the bytes are not those that `seal` returned.
    """
    view = memoryview(content)
    length = view[len(MARK) : len(MARK) + LENGTH.size]
    digest, inner = view[len(MARK) + LENGTH.size : SIZE], view[SIZE:]
    if not is_sealed(content) or len(view) < SIZE or LENGTH.unpack(length)[0] != len(inner):
        raise DamagedFile("was cut, or does not begin with the mark of a sealed file")
    proof = hashlib.sha256(length)
    proof.update(inner)
    if proof.digest() != digest:
        raise DamagedFile("is damaged: its SHA-256 is that of another content")
    return inner
