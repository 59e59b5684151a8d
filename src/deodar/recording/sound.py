"""The sound part of a record that was written during a run.

Chunks that are missing or damaged end the record before them.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray

from deodar import codec
from deodar.recording import portable
from deodar.recording.record import about

DAMAGED = "damaged"
"""Name of the attribute that states what was left out of a damaged record."""


def present(record: xarray.Dataset, path: Path) -> xarray.Dataset:
    """Return a stored Dataset, as a Zarr folder has it, without the samples from a missing chunk on.

    Args:
        record: the Dataset before `portable.unpack`.
        path: its folder.
    """
    ends: dict[str, tuple[int, str]] = {}
    for name, old, axis in _growing(record):
        variable = record.variables[name]
        chunks = variable.encoding["chunks"]
        count = [math.ceil(n / c) for n, c in zip(variable.shape, chunks, strict=True)]
        whole = axis == 0 or _complete(record)
        rows = itertools.product(*(range(n) if i != axis else [0] for i, n in enumerate(count)))
        missing = [
            k for row in rows if (k := _missing(path / name / "c", row, axis, count[axis], whole)) >= 0
        ]
        if missing:
            _shorten(ends, str(variable.dims[axis]), min(missing) * chunks[axis], old)
    return _cut(record, ends, "missing")


def _growing(record: xarray.Dataset) -> Iterator[tuple[str, str, int]]:
    """Yield for each stored array that grows its name, that in the record, and the axis that grows."""
    layout = _layout(record)
    names: Mapping[str, str] = layout.get("names", {})
    for name, stored in layout.get("variables", {}).items():
        if "grows" in stored and name in record.variables:
            dims = [names.get(str(d), str(d)) for d in record.variables[name].dims]
            yield name, names.get(name, name), dims.index(stored["grows"])


def _missing(folder: Path, row: tuple[int, ...], axis: int, count: int, whole: bool) -> int:
    """Return the number of the first missing chunk in a row along the growing axis, or -1.

    A row of copies need not be `whole` in an incomplete record: what follows its last chunk is not written
    yet.
    """
    exists = [folder.joinpath(*map(str, (*row[:axis], k, *row[axis + 1 :]))).is_file() for k in range(count)]
    end = count if whole else max((k for k in range(count) if exists[k]), default=-1)
    return next((k for k in range(end) if not exists[k]), -1)


def readable(record: xarray.Dataset) -> xarray.Dataset:
    """Return a stored Dataset without the samples from a chunk on that cannot be read.

    Raises:
        Exception: an array that does not grow cannot be read.
    """
    ends: dict[str, tuple[int, str]] = {}
    for name, old, axis in _growing(record):
        variable = record.variables[name]
        frames = variable.encoding["chunks"][axis]
        for first in range(0, variable.shape[axis], frames):
            try:
                variable.isel({variable.dims[axis]: slice(first, first + frames)}).to_numpy()
            except Exception:  # libraries that read untrusted bytes may raise any exception
                _shorten(ends, str(variable.dims[axis]), first, old)
                break
    return _cut(record, ends, "damaged")


def _layout(record: xarray.Dataset) -> dict[str, Any]:
    text = record.attrs.get(portable.KEY)
    return {} if text is None else codec.parse(text)


def _complete(record: xarray.Dataset) -> bool:
    return bool(about(record).get("complete", True))


def _shorten(ends: dict[str, tuple[int, str]], dimension: str, length: int, name: str) -> None:
    if dimension not in ends or length < ends[dimension][0]:
        ends[dimension] = length, name


def _cut(record: xarray.Dataset, ends: dict[str, tuple[int, str]], state: str) -> xarray.Dataset:
    if not ends:
        return record
    sentence = "; ".join(
        f"{record.sizes[d] - n} of {record.sizes[d]} samples of {d} are left out:"
        f" a chunk of {name} is {state}"
        for d, (n, name) in ends.items()
    )
    before = record.attrs.get(DAMAGED)
    layout = _layout(record)
    layout["attributes"][DAMAGED] = None
    attributes = {DAMAGED: f"{before}; {sentence}" if before else sentence, portable.KEY: codec.line(layout)}
    return record.isel({d: slice(n) for d, (n, _) in ends.items()}).assign_attrs(attributes)
