"""NetCDF 3 files, written in blocks, so that a record may be larger than the memory.

The form is the 64-bit offset variant of the classic format: a header that states names, dimensions,
attributes and positions, then the arrays, big-endian and one after another (NetCDF Users' Guide, "File Format
Specifications").
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
import xarray

from deodar.recording.slabs import Slab, slabs

LARGEST = 2**32 - 8
"""Largest number of bytes of one array."""

BLOCK = 2**22
"""Number of values that are written at a time."""

MAGIC = b"CDF\x02"
DIMENSION, VARIABLE, ATTRIBUTE = 10, 11, 12
CHAR, INT, DOUBLE = 2, 4, 6
TYPES = {"i1": 1, "i2": 3, "i4": INT, "f4": 5, "f8": DOUBLE}

ReadSlab = Callable[[Slab], np.ndarray]
"""Returns a block of an array."""


def write(stored: xarray.Dataset, read: Mapping[str, ReadSlab], path: Path) -> None:
    """Write a file.

    Args:
        stored: a Dataset that the format can hold, as `portable.pack` returns it; arrays up to `LARGEST`.
        read: for each variable the function that reads a block of it.
        path: the file.
    """
    length = len(_header(stored, 0))
    with path.open("wb") as file:
        file.write(_header(stored, length))
        for name, variable in stored.variables.items():
            _array(file, variable, read[str(name)])


def _array(file: IO[bytes], variable: xarray.Variable, read: ReadSlab) -> None:
    kind = variable.dtype.newbyteorder(">")
    for slab in slabs(variable.shape, BLOCK):
        file.write(np.ascontiguousarray(read(slab)).astype(kind).tobytes())
    file.write(bytes(_padded(variable.nbytes) - variable.nbytes))


def _header(stored: xarray.Dataset, length: int) -> bytes:
    """Return the header of a file whose header has that length."""
    sizes = {str(name): size for name, size in stored.sizes.items()}
    numbers = {name: n for n, name in enumerate(sizes)}
    parts = [MAGIC, _int(0), _many(DIMENSION, [_name(name) + _int(size) for name, size in sizes.items()])]
    parts.append(_attributes(stored.attrs))
    variables: list[bytes] = []
    begin = length
    for name, variable in stored.variables.items():
        attributes = dict(variable.attrs)
        others = [str(c) for c in stored.coords if c not in sizes]
        beside = [c for c in others if set(stored[c].dims) <= set(variable.dims)]
        if name not in stored.coords and beside:
            attributes["coordinates"] = " ".join(beside)
        size = _padded(variable.nbytes)
        variables.append(
            _name(str(name))
            + _int(variable.ndim)
            + b"".join(_int(numbers[str(d)]) for d in variable.dims)
            + _attributes(attributes)
            + _int(TYPES[variable.dtype.str[1:]])
            + struct.pack(">Iq", size, begin)
        )
        begin += size
    parts.append(_many(VARIABLE, variables))
    return b"".join(parts)


def _attributes(attributes: Mapping[Any, Any]) -> bytes:
    return _many(ATTRIBUTE, [_name(str(key)) + _value(value) for key, value in attributes.items()])


def _value(value: Any) -> bytes:
    """Return type, number of values and values of an attribute."""
    if isinstance(value, str):
        text = value.encode()
        return _int(CHAR) + _int(len(text)) + _fill(text)
    array = np.atleast_1d(np.asarray(value))
    small = array.dtype.kind in "iu" and abs(array).max() < 2**31
    code, kind = (INT, ">i4") if small else (DOUBLE, ">f8")
    return _int(code) + _int(array.size) + _fill(array.astype(kind).tobytes())


def _many(tag: int, items: list[bytes]) -> bytes:
    return _int(tag if items else 0) + _int(len(items)) + b"".join(items)


def _name(text: str) -> bytes:
    encoded = text.encode()
    return _int(len(encoded)) + _fill(encoded)


def _int(number: int) -> bytes:
    return struct.pack(">i", number)


def _fill(content: bytes) -> bytes:
    return content + bytes(_padded(len(content)) - len(content))


def _padded(size: int) -> int:
    """Return a number of bytes that is a multiple of 4."""
    return -(-size // 4) * 4
