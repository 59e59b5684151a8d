"""The chunks of an array in a Zarr record, written and read as files.

Zarr's own functions need about a millisecond of Python for a chunk. A run that records fills hundreds of
chunks a second, and would share its cores with them. The files are those that Zarr reads and writes: the
values in C order, compressed, followed by the checksum of the compressed bytes (CRC-32C).
"""

from __future__ import annotations

import itertools
import math
import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import google_crc32c
import numcodecs
import numpy as np
import zarr.codecs

from deodar import regular_file
from deodar.errors import DamagedFile, RecordError
from deodar.model import output
from deodar.recording.slabs import Slab

ChunkIndex = tuple[int, ...]
"""Number of a chunk along each axis."""

COMPRESSORS = (zarr.codecs.BloscCodec(cname="lz4", clevel=1, shuffle="shuffle"), zarr.codecs.Crc32cCodec())
"""What new arrays are written with.

The bytes of equal significance of all values stand together, since the first of them hardly change. Of noisy
fields the files are 0.6 to 0.8 of the values; zstd at its first level needs 2 to 10 times as long and leaves
more.
"""

SHUFFLES = ("noshuffle", "shuffle", "bitshuffle")


class ChunkedArray:
    """An array of a record, without its length along the dimension that grows.

    Args:
        folder: the folder of the array.
        metadata: its metadata, as Zarr (version 3) states them.
        whole: whether each chunk has a file, so that a missing one is damage.

    Attributes:
        shape: its shape when it was opened.
        chunks: shape of a chunk.
        dtype: type of the values, in the order of bytes of the files.
        fill: value of a place that no chunk has.

    Raises:
        RecordError: its chunks are encoded in a way that this version does not know.
    """

    def __init__(self, folder: Path, metadata: Mapping[str, Any], whole: bool = False) -> None:
        self.folder, self.name, self.whole = folder, folder.name, whole
        self.shape = tuple(map(int, metadata["shape"]))
        self.chunks = tuple(map(int, metadata["chunk_grid"]["configuration"]["chunk_shape"]))
        self.dtype = np.dtype(str(metadata["data_type"])).newbyteorder("<")
        self.fill = math.nan if metadata["fill_value"] == "NaN" else metadata["fill_value"]
        key, named = (
            metadata["chunk_key_encoding"],
            [(c["name"], c.get("configuration", {})) for c in metadata["codecs"]],
        )
        names = [name for name, _ in named]
        self._checked = names[-1] == "crc32c"
        compressors = names[1 : -1 if self._checked else None]
        little = named[0][1].get("endian", "little") == "little"
        plain = isinstance(self.fill, int | float) and self.dtype.kind in "fiub"
        if (
            names[0] != "bytes"
            or compressors not in (["blosc"], ["zstd"])
            or not (little and plain)
            or key != {"name": "default", "configuration": {"separator": "/"}}
        ):
            raise RecordError(
                f"has chunks that were encoded by {', '.join(names)}, which this version cannot continue",
                where=folder.name,
            )
        settings = named[1][1]
        if names[1] == "zstd":
            self._codec: Any = numcodecs.Zstd(int(settings["level"]), bool(settings.get("checksum", False)))
        else:
            self._codec = numcodecs.Blosc(
                str(settings["cname"]),
                int(settings["clevel"]),
                SHUFFLES.index(settings["shuffle"]),
                int(settings["blocksize"]),
            )

    def store(self, start: Sequence[int], values: np.ndarray) -> None:
        """Write the chunks that contain `values`, whose first value is at `start`.

        Values of these chunks beside them stay; beyond the end of the array they are the fill value.

        Raises:
            DamagedFile: a chunk that is partly overwritten cannot be read.
            OSError: the system refused.
        """
        for place, inner, outer in self._parts(start, values.shape):
            part = values[*outer]
            if part.shape == self.chunks:
                self.write(place, part)
                continue
            whole = self.empty() if self._covers(place, inner) else self.read(place)
            whole[*inner] = part
            self.write(place, whole)

    def load(self, start: Sequence[int], shape: Sequence[int]) -> np.ndarray:
        """Return a block of this shape whose first value is at `start`; what no chunk has is the fill value.

        Raises:
            DamagedFile: a chunk is damaged.
        """
        block = np.empty(shape, self.dtype)
        for place, inner, outer in self._parts(start, shape):
            block[*outer] = self.read(place)[*inner]
        return block

    def _parts(self, start: Sequence[int], shape: Sequence[int]) -> Iterator[tuple[ChunkIndex, Slab, Slab]]:
        """Yield the chunks of a block, with the part of each chunk and where it is in the block."""
        stop = [first + n for first, n in zip(start, shape, strict=True)]
        ranges = [range(a // c, -(-b // c)) for a, b, c in zip(start, stop, self.chunks, strict=True)]
        for place in itertools.product(*ranges):
            origin = [k * c for k, c in zip(place, self.chunks, strict=True)]
            low = [max(a, o) for a, o in zip(start, origin, strict=True)]
            high = [min(b, o + c) for b, o, c in zip(stop, origin, self.chunks, strict=True)]
            inner = (slice(a - o, b - o) for a, b, o in zip(low, high, origin, strict=True))
            outer = (slice(a - s, b - s) for a, b, s in zip(low, high, start, strict=True))
            yield place, tuple(inner), tuple(outer)

    def _covers(self, place: ChunkIndex, inner: Slab) -> bool:
        """Return whether a part of a chunk is all that the array has of it."""
        ends = (min(c, n - k * c) for k, c, n in zip(place, self.chunks, self.shape, strict=True))
        return all(
            part.start == 0 and part.stop in (end, c)
            for part, end, c in zip(inner, ends, self.chunks, strict=True)
        )

    def write(self, place: ChunkIndex, values: np.ndarray) -> None:
        """Write a chunk beside its final path, and rename it.

        Raises:
            OSError: the system refused.
        """
        self.put(place, self.encode(values))

    def put(self, place: ChunkIndex, content: bytes) -> None:
        """Write the file of a chunk."""
        path = self.path(place)
        try:
            output.replace(path, content)
        except FileNotFoundError:  # the folders of the array are not removed while it is written
            for parent in reversed(path.relative_to(self.folder).parents[:-1]):
                self.folder.joinpath(parent).mkdir(exist_ok=True)
            output.replace(path, content)

    def get(self, place: ChunkIndex) -> bytes:
        """Return the content of the file of a chunk."""
        return regular_file.read_bytes(self.path(place))

    def read(self, place: ChunkIndex, room: np.ndarray | None = None) -> np.ndarray:
        """Return a chunk that may be changed: fill values if there is none.

        Args:
            place: the number of the chunk.
            room: an array of the shape of a chunk that is overwritten and returned; None: a new one.

        Raises:
            DamagedFile: it is damaged, or missing in an array that has all chunks.
        """
        chunk = self.empty() if room is None else room
        try:
            content: Any = np.frombuffer(self.get(place), np.uint8)
        except FileNotFoundError:
            if self.whole:
                raise self._damaged(place, "it is missing") from None
            chunk.fill(self.fill)
            return chunk
        try:
            self.decode(content, chunk)
        except DamagedFile as error:
            raise self._damaged(place, error.problems[0].what) from None
        return chunk

    def _damaged(self, place: ChunkIndex, reason: str) -> DamagedFile:
        number = ", ".join(map(str, place)) or "0"
        return DamagedFile(
            f"is damaged: chunk {number} of {self.name} cannot be read: {reason}",
            where=str(self.folder.parent),
        )

    def encode(self, values: np.ndarray) -> bytes:
        """Return the content of the file of a chunk."""
        content = bytes(self._codec.encode(np.ascontiguousarray(values, self.dtype)))
        return content + struct.pack("<I", google_crc32c.value(content)) if self._checked else content

    def decode(self, content: np.ndarray, room: np.ndarray) -> None:
        """Write the values of a chunk into an array of its shape.

        Args:
            content: the bytes of its file.
            room: the array.

        Raises:
            DamagedFile: it is damaged.
        """
        if self._checked:
            content, checksum = content[:-4], content[-4:]
            # the checksum is computed from a buffer
            bare: Any = content
            if checksum.tobytes() != struct.pack("<I", google_crc32c.value(bare)):
                raise DamagedFile("its checksum is that of other values")
        try:
            self._codec.decode(content, room)
        except (ValueError, RuntimeError) as error:
            raise DamagedFile(str(error)) from None

    def empty(self) -> np.ndarray:
        """Return a chunk of fill values."""
        return np.full(self.chunks, self.fill, self.dtype)

    def path(self, place: ChunkIndex) -> Path:
        """Return the file of a chunk."""
        return self.folder.joinpath("c", *map(str, place))
