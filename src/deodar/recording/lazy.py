"""Arrays of a Zarr record that read what is selected, several chunks at once.

A time course of one place needs every chunk of a field. Threads read, check and decompress them, and keep of
each only what is selected. Zarr needs a millisecond of Python for a chunk, one after another.
"""

from __future__ import annotations

import itertools
import os
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray
from xarray.backends import BackendArray
from xarray.core import indexing

from deodar.errors import RecordError
from deodar.recording import portable
from deodar.recording.chunks import ChunkedArray

FEW = 4
"""Number of chunks that one thread reads."""

THREADS = 8
"""Largest number of threads (a guess: beyond, the memory is the limit)."""


class _Part(NamedTuple):
    """A chunk along one axis: which of its places are selected, and where they are in the result."""

    chunk: int
    inner: np.ndarray
    outer: slice


class LazyArray(BackendArray):
    """An array of a record as xarray indexes it.

    Args:
        array: its chunks.
        shape: its shape.
    """

    def __init__(self, array: ChunkedArray, shape: Sequence[int]) -> None:
        self.array, self.shape = array, tuple(shape)
        self.dtype = array.dtype.newbyteorder("=")

    def __getitem__(self, key: Any) -> Any:
        """Return the selected values."""
        support = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, support, self._selected)

    def _selected(self, key: tuple[Any, ...]) -> np.ndarray:
        """Return the values of an outer index: a number, slice or array of numbers for each axis."""
        indices = [np.arange(n)[k] for k, n in zip(key, self.shape, strict=True)]
        axes = [_parts(np.atleast_1d(w), c) for w, c in zip(indices, self.array.chunks, strict=True)]
        selected = np.empty([np.size(w) for w in indices], self.dtype)
        rooms = threading.local()

        def take(parts: tuple[_Part, ...]) -> None:
            if not hasattr(rooms, "chunk"):
                rooms.chunk = self.array.empty()
            try:
                chunk = self.array.read(tuple(part.chunk for part in parts), rooms.chunk)
            except OSError as error:
                where = str(self.array.folder.parent)
                raise RecordError(
                    f"{self.array.name} cannot be read: {error.strerror or error}", where=where
                ) from None
            selected[tuple(part.outer for part in parts)] = chunk[np.ix_(*(part.inner for part in parts))]

        places = list(itertools.product(*axes))
        threads = min(THREADS, os.cpu_count() or 1)
        if len(places) <= FEW or threads == 1:
            for place in places:
                take(place)
        else:
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(take, places, chunksize=16))
        return selected.reshape([n for w in indices for n in w.shape])


def _parts(places: np.ndarray, size: int) -> list[_Part]:
    """Return the chunks of this size that contain the wanted places, in their order."""
    if not places.size:
        return []
    chunks = places // size
    starts = [0, *(np.flatnonzero(np.diff(chunks)) + 1).tolist(), len(places)]
    return [
        _Part(int(chunks[a]), places[a:b] - chunks[a] * size, slice(a, b))
        for a, b in itertools.pairwise(starts)
    ]


def opened(path: Path, group: Mapping[str, Any]) -> xarray.Dataset | None:
    """Return the Dataset of a Zarr folder whose arrays are read by threads, when they are used; None: an
    array is encoded in another way, as one of texts or of another program.

    Args:
        path: its folder.
        group: its metadata, with those of its arrays.

    Raises:
        RecordError: a coordinate cannot be read.
    """
    whole = portable.whole_arrays(group["attributes"])
    variables: dict[str, xarray.Variable] = {}
    try:
        for name, metadata in group["consolidated_metadata"]["metadata"].items():
            array = ChunkedArray(path / name, metadata, name in whole)
            values = indexing.LazilyIndexedArray(LazyArray(array, array.shape))
            attributes, dims = dict(metadata["attributes"]), metadata["dimension_names"]
            variables[name] = xarray.Variable(dims, values, attributes, {"chunks": array.chunks})
    except (RecordError, LookupError, TypeError):
        return None
    return xarray.Dataset(variables, attrs=dict(group["attributes"]))
