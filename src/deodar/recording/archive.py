"""Several records as one Zarr group (version 3) in a zip file.

Each record is a group of its own, with the arrays of every Zarr record of deodar, so that records of
different lengths are stored as they are, without padding, and other programs open one by its name:
`xarray.open_zarr(zarr.storage.ZipStore(FILE), group=NAME, consolidated=False)`. Chunks are compressed once,
and stored in the zip file as they are. Equal records give equal bytes: entries have a fixed date. Zarr's own
functions need tens of milliseconds for a record, this module about two.
"""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
import xarray

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import DamagedFile, RecordError, reading
from deodar.recording import portable
from deodar.recording.chunks import ChunkedArray, ChunkIndex

CHUNK_BYTES = 2**26
"""Bytes of a chunk before compression: most arrays of a trial have one chunk, and are read whole."""

META = "zarr.json"
"""Name of the metadata of a group or an array."""

CODECS: tuple[JsonObject, ...] = (
    {"name": "bytes", "configuration": {"endian": "little"}},
    {
        "name": "blosc",
        "configuration": {"cname": "lz4", "clevel": 1, "shuffle": "shuffle", "typesize": 1, "blocksize": 0},
    },
    {"name": "crc32c"},
)
"""What arrays are encoded by, as in every Zarr record of deodar; `typesize` follows from the array."""


class ArchiveWriter:
    """Collects records, and returns the bytes of the file."""

    def __init__(self) -> None:
        self._file = io.BytesIO()
        self._zip = zipfile.ZipFile(self._file, "w", zipfile.ZIP_STORED)

    def add(self, name: str, record: xarray.Dataset) -> None:
        """Add a record as the group `name`."""
        stored = portable.pack(record, narrow=False)
        members: JsonObject = {}
        for new, whole in portable.sources(record, stored).items():
            members[new] = metadata = _metadata(stored.variables[new])
            array = _ZippedArray(self._zip, f"{name}/{new}", metadata)
            array.store([0] * whole.ndim, np.asarray(whole.values))
            _store(self._zip, f"{name}/{new}/{META}", codec.line(metadata).encode())
        inline: JsonObject = {"kind": "inline", "must_understand": False, "metadata": members}
        _store(self._zip, f"{name}/{META}", _group(dict(stored.attrs), inline))

    def close(self, attributes: Mapping[str, Json]) -> bytes:
        """Return the file; `attributes` are those of the group that contains all records.

        They are the last entry, beside the directory of the zip file, so that both are read at once.
        """
        _store(self._zip, META, _group(dict(attributes)))
        self._zip.close()
        return self._file.getvalue()


class Archive:
    """An opened file of records.

    Args:
        file: the file, which must allow seeking; `close` closes it.
        where: its name, for errors.

    Attributes:
        attributes: attributes of the group that contains all records.

    Raises:
        RecordError: it is damaged, or no such file.
    """

    def __init__(self, file: IO[bytes], where: str) -> None:
        self._file, self.where = file, where
        try:
            self._zip = zipfile.ZipFile(file)
            self.attributes: dict[str, Any] = codec.parse(self._zip.read(META))["attributes"]
        except Exception as error:  # libraries that read untrusted bytes may raise any exception
            file.close()
            raise self._damaged(error) from None

    def read(self, name: str) -> xarray.Dataset:
        """Return a record; its values are compared with their checksums.

        Raises:
            RecordError: it does not exist, is damaged, or of a later version.
        """
        try:
            group = codec.parse(self._zip.read(f"{name}/{META}"))
            with reading(f"{self.where}: {name}", RecordError):
                portable.require_proof(group["attributes"], True)
            members: Mapping[str, Any] = group["consolidated_metadata"]["metadata"]
            variables = {new: self._variable(name, new, metadata) for new, metadata in members.items()}
            return portable.unpack(xarray.Dataset(variables, attrs=group["attributes"]))
        except RecordError as error:
            if isinstance(error, DamagedFile):
                raise self._damaged(error, name) from None
            raise
        except Exception as error:  # libraries that read untrusted bytes may raise any exception
            raise self._damaged(error, name) from None

    def require_sound(self) -> None:
        """Raise RecordError if a part of the file is not what was written."""
        try:
            bad = self._zip.testzip()
        except Exception as error:  # libraries that read untrusted bytes may raise any exception
            raise self._damaged(error) from None
        if bad is not None:
            raise DamagedFile(f"is damaged: the checksum of {bad} is wrong", where=self.where)

    def close(self) -> None:
        """Close the file."""
        self._zip.close()
        self._file.close()

    def _variable(self, name: str, new: str, metadata: Mapping[str, Any]) -> xarray.Variable:
        array = _ZippedArray(self._zip, f"{name}/{new}", metadata)
        try:
            values = array.load([0] * len(array.shape), array.shape)
        except DamagedFile as error:
            raise DamagedFile(f"{new}: {error.problems[0].what}") from None
        return xarray.Variable(metadata["dimension_names"], values, metadata["attributes"])

    def _damaged(self, error: Exception, name: str = "") -> RecordError:
        text = " ".join(str(error).split())[:200]
        fault = f"the record {name} of it cannot be read" if name else "cannot be read as a file of records"
        return RecordError(
            f"{fault}, it may be damaged ({type(error).__name__}: {text})",
            where=self.where,
            fix="Take another copy, or run its trials again",
        )


class _ZippedArray(ChunkedArray):
    """An array whose chunks are entries of a zip file."""

    def __init__(self, archive: zipfile.ZipFile, folder: str, metadata: Mapping[str, Any]) -> None:
        super().__init__(Path(folder), metadata)
        self._zip = archive

    def put(self, place: ChunkIndex, content: bytes) -> None:
        """Add the entry of a chunk."""
        _store(self._zip, self.path(place).as_posix(), content)

    def get(self, place: ChunkIndex) -> bytes:
        """Return the entry of a chunk."""
        return self._zip.read(self.path(place).as_posix())


def _store(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    entry = zipfile.ZipInfo(name)
    entry.create_system, entry.external_attr = 3, 0o644 << 16  # the same bytes on every system
    archive.writestr(entry, content)


def _metadata(variable: xarray.Variable) -> JsonObject:
    """Return the metadata of an array, as Zarr (version 3) states them."""
    inner = max(1, variable.dtype.itemsize * math.prod(variable.shape[1:]))
    first = [min(variable.shape[0], max(1, CHUNK_BYTES // inner))] if variable.ndim else []
    blosc: Any = CODECS[1]
    settings = {**blosc["configuration"], "typesize": variable.dtype.itemsize}
    return {
        "zarr_format": 3,
        "node_type": "array",
        "shape": list(variable.shape),
        "data_type": str(variable.dtype.newbyteorder("=")),
        "chunk_grid": {
            "name": "regular",
            "configuration": {"chunk_shape": [max(1, n) for n in (*first, *variable.shape[1:])]},
        },
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": {"b": False, "f": 0.0}.get(variable.dtype.kind, 0),
        "codecs": [CODECS[0], {**blosc, "configuration": settings}, CODECS[2]],
        "attributes": dict(variable.attrs),
        "dimension_names": [str(d) for d in variable.dims],
        "storage_transformers": [],
    }


def _group(attributes: JsonObject, inline: JsonObject | None = None) -> bytes:
    metadata: JsonObject = {"zarr_format": 3, "node_type": "group", "attributes": attributes}
    return codec.line(metadata | ({} if inline is None else {"consolidated_metadata": inline})).encode()
