"""NetCDF 3 files, written and read in blocks, so that a record may be larger than the memory.

The form is the 64-bit offset variant of the classic format: a header that states names, dimensions,
attributes and positions, then the arrays, big-endian and one after another (NetCDF Users' Guide, "File Format
Specifications"). An attribute of each array states the CRC-32C of its blocks, and one of the file the SHA-256
of the header; both are checked when they are read, also by readers that read a part.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, NamedTuple

import google_crc32c
import numpy as np
import xarray
from xarray.backends import BackendArray
from xarray.core import indexing

from deodar import regular_file
from deodar.errors import DamagedFile
from deodar.recording.portable import CHECKSUMS, NO_PROOF, PROOF
from deodar.recording.slabs import Slab, slabs

LARGEST = 2**32 - 8
"""Largest number of bytes of one array."""

BLOCK = 2**22
"""Number of values that are written at a time."""

CHECKED_BYTES = 2**20
"""Bytes of an array that have a checksum together."""

MAGIC = b"CDF"
OFFSETS = {1: struct.Struct(">i"), 2: struct.Struct(">q")}
"""How a version states where an array begins."""

DIMENSION, VARIABLE, ATTRIBUTE = 10, 11, 12
CHAR, INT, DOUBLE = 2, 4, 6
TYPES = {"i1": 1, "S1": CHAR, "i2": 3, "i4": INT, "f4": 5, "f8": DOUBLE}
DTYPES = {number: np.dtype(name).newbyteorder(">") for name, number in TYPES.items()}

ReadSlab = Callable[[Slab], np.ndarray]
"""Returns a block of an array."""


def write(stored: xarray.Dataset, read: Mapping[str, ReadSlab], path: Path) -> None:
    """Write a file.

    Args:
        stored: a Dataset that the format can hold, as `portable.pack` returns it; arrays up to `LARGEST`.
        read: for each variable the function that reads a block of it.
        path: the file.
    """
    checksums = {str(name): [0] * -(-v.nbytes // CHECKED_BYTES) for name, v in stored.variables.items()}
    length = len(_header(stored, 0, checksums))
    with path.open("wb") as file:
        file.write(bytes(length))
        for name, variable in stored.variables.items():
            checksums[str(name)] = _array(file, variable, read[str(name)])
        header = _header(stored, length, checksums)
        proof = hashlib.sha256(header).hexdigest()
        file.seek(0)
        file.write(header.replace(_value(NO_PROOF), _value(proof), 1))


def _array(file: IO[bytes], variable: xarray.Variable, read: ReadSlab) -> list[int]:
    """Write an array, and return the checksums of its blocks."""
    kind, checksums, room = variable.dtype.newbyteorder(">"), [0], CHECKED_BYTES
    for slab in slabs(variable.shape, BLOCK):
        content = memoryview(np.ascontiguousarray(read(slab)).astype(kind).tobytes())
        file.write(content)
        while content:
            if not room:
                checksums.append(0)
                room = CHECKED_BYTES
            checksums[-1] = google_crc32c.extend(checksums[-1], bytes(content[:room]))
            room, content = room - len(content[:room]), content[room:]
    file.write(bytes(_padded(variable.nbytes) - variable.nbytes))
    return checksums if variable.nbytes else []


def _header(stored: xarray.Dataset, length: int, checksums: Mapping[str, Sequence[int]]) -> bytes:
    """Return the header of a file whose header has that length, with zeros for its proof."""
    sizes = {str(name): size for name, size in stored.sizes.items()}
    numbers = {name: n for n, name in enumerate(sizes)}
    parts = [MAGIC, b"\x02", _int(0)]
    parts.append(_many(DIMENSION, [_name(name) + _int(size) for name, size in sizes.items()]))
    parts.append(_attributes({PROOF: NO_PROOF, **stored.attrs}))
    variables: list[bytes] = []
    begin = length
    for name, variable in stored.variables.items():
        attributes = dict(variable.attrs)
        others = [str(c) for c in stored.coords if c not in sizes]
        beside = [c for c in others if set(stored[c].dims) <= set(variable.dims)]
        if name not in stored.coords and beside:
            attributes["coordinates"] = " ".join(beside)
        attributes[CHECKSUMS] = " ".join(f"{checksum:08x}" for checksum in checksums[str(name)])
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


# ---------------------------------------------------------------------------------------------------- reading


class _ArrayHeader(NamedTuple):
    """What the header states about an array."""

    dims: list[str]
    attributes: dict[str, Any]
    dtype: np.dtype[Any]
    begin: int


def read(path: Path) -> xarray.Dataset:
    """Return a file as a Dataset whose arrays are read, and compared with their checksums, when they are
    used. A file without checksums is of an earlier version.

    Raises:
        DamagedFile: its header is not the one that was written, or the file is too short.
    """
    with regular_file.open_binary(path) as file:
        content: Any = np.memmap(file, np.uint8, "r")
    try:
        header = _Header(memoryview(content))
        sizes, attributes, entries = header.read()
    except (LookupError, struct.error, UnicodeDecodeError, ValueError) as error:
        raise DamagedFile(f"is damaged: its header cannot be read ({error})") from None
    proof = attributes.get(PROOF)
    if proof is not None:
        written = header.read_bytes.replace(_value(str(proof)), _value(NO_PROOF), 1)
        if hashlib.sha256(written).hexdigest() != proof:
            raise DamagedFile("is damaged: its header is not the one that was written")
    variables: dict[str, Any] = {}
    for name, entry in entries.items():
        shape = [sizes[d] for d in entry.dims]
        size = int(np.prod(shape, dtype=object)) * entry.dtype.itemsize
        if entry.begin < 0 or entry.begin + size > content.size:
            raise DamagedFile(f"is damaged: it ends before the end of {name!r}")
        values = content[entry.begin : entry.begin + size].view(entry.dtype).reshape(shape)
        checksums = [int(text, 16) for text in str(entry.attributes.pop(CHECKSUMS, "")).split()]
        lazy: Any = indexing.LazilyIndexedArray(_CheckedArray(values, name, checksums))
        variables[name] = xarray.Variable(entry.dims, lazy, entry.attributes)
    return xarray.Dataset(variables, attrs=attributes)


class _Header:
    """The header of a file, read from its beginning."""

    def __init__(self, content: memoryview) -> None:
        self._content, self._at = content, 0

    @property
    def read_bytes(self) -> bytes:
        """What was read so far."""
        return bytes(self._content[: self._at])

    def read(self) -> tuple[dict[str, int], dict[str, Any], dict[str, _ArrayHeader]]:
        """Return the sizes of the dimensions, the attributes, and the arrays by their names."""
        magic, version = bytes(self._take(3)), self._take(1)[0]
        if magic != MAGIC or self._int() != 0:
            raise ValueError("it has records of its own, or is no NetCDF 3")
        offset = OFFSETS[version]
        sizes = {self._text(): self._int() for _ in self._items(DIMENSION)}
        attributes, names = self._attributes(), list(sizes)
        entries: dict[str, _ArrayHeader] = {}
        for _ in self._items(VARIABLE):
            name = self._text()
            dims = [names[self._int()] for _ in range(self._int())]
            array_attributes, dtype = self._attributes(), self._type()
            self._int()  # the size, which follows from the shape
            [begin] = offset.unpack(self._take(offset.size))
            entries[name] = _ArrayHeader(dims, array_attributes, dtype, begin)
        return sizes, attributes, entries

    def _items(self, tag: int) -> Iterator[int]:
        stated, count = self._int(), self._int()
        if stated not in (0, tag) or (count and not stated):
            raise ValueError(f"a list is marked {stated}")
        return iter(range(count))

    def _attributes(self) -> dict[str, Any]:
        return {self._text(): self._constant() for _ in self._items(ATTRIBUTE)}

    def _constant(self) -> Any:
        dtype, count = self._type(), self._int()
        content = self._padded(count * dtype.itemsize)
        if dtype.kind == "S":
            return bytes(content).decode()
        values = np.frombuffer(content, dtype).astype(dtype.newbyteorder("="))
        return values[0] if count == 1 else values

    def _type(self) -> np.dtype[Any]:
        return DTYPES[self._int()]

    def _text(self) -> str:
        return bytes(self._padded(self._int())).decode()

    def _int(self) -> int:
        return struct.unpack(">i", self._take(4))[0]

    def _padded(self, size: int) -> memoryview:
        return self._take(_padded(size))[:size]

    def _take(self, size: int) -> memoryview:
        if not 0 <= size <= len(self._content) - self._at:
            raise ValueError("the file is too short")
        self._at += size
        return self._content[self._at - size : self._at]


class _CheckedArray(BackendArray):
    """An array of a file as xarray indexes it: a block is compared with its checksum when it is first used.

    Args:
        values: the array in the file.
        name: its name, for errors.
        checksums: CRC-32C of each of its blocks; none: it is not compared.
    """

    def __init__(self, values: np.ndarray, name: str, checksums: Sequence[int]) -> None:
        self._values, self._name = values, name
        self._unchecked = dict(enumerate(checksums))
        self.shape, self.dtype = values.shape, values.dtype.newbyteorder("=")

    def __getitem__(self, key: Any) -> Any:
        """Return the selected values."""
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._selected)

    def _selected(self, key: tuple[Any, ...]) -> np.ndarray:
        """Return the values of an outer index: a number, slice or array of numbers for each axis."""
        places = [np.arange(n)[k] for k, n in zip(key, self.shape, strict=True)]
        self._check(*_span(places, self._values))
        chosen = np.asarray(self._values)  # a view until its order of bytes is changed: one copy in memory
        for axis, (k, place) in enumerate(zip(key, places, strict=True)):
            chosen = chosen[(*[slice(None)] * axis, k if isinstance(k, slice) else np.atleast_1d(place))]
        return chosen.astype(self.dtype).reshape([n for place in places for n in place.shape])

    def _check(self, first: int, stop: int) -> None:
        """Compare the blocks between two bytes with their checksums."""
        if not self._unchecked or first >= stop:
            return
        content = self._values.reshape(-1).view(np.uint8)
        for block in range(first // CHECKED_BYTES, -(-stop // CHECKED_BYTES)):
            checksum = self._unchecked.get(block)
            if checksum is None:
                continue
            part = content[block * CHECKED_BYTES : (block + 1) * CHECKED_BYTES]
            if google_crc32c.value(part.tobytes()) != checksum:
                raise DamagedFile(f"is damaged: the values of {self._name!r} are not those that were written")
            self._unchecked.pop(block, None)  # another thread may have compared it, too


def _span(places: Sequence[np.ndarray], values: np.ndarray) -> tuple[int, int]:
    """Return the first byte of selected values and the one after the last."""
    if not all(place.size for place in places):
        return 0, 0
    ends = [(int(place.min()), int(place.max())) for place in places]
    first = sum(low * stride for (low, _), stride in zip(ends, values.strides, strict=True))
    last = sum(high * stride for (_, high), stride in zip(ends, values.strides, strict=True))
    return first, last + values.itemsize
