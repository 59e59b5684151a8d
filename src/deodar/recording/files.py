"""Records as files: Zarr and NetCDF, which are read back exactly, and CSV for other programs.

A record is written beside its final path and renamed, so it is complete or absent.
"""

from __future__ import annotations

import contextlib
import stat
import warnings
from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import xarray

from deodar import codec, regular_file
from deodar.errors import (
    DeodarError,
    OutputExists,
    Problem,
    RecordError,
    RunWarning,
    TooLarge,
    did_you_mean,
)
from deodar.model import output
from deodar.recording import group_file, growing, lazy, netcdf, places, portable, sound, table
from deodar.recording.chunks import COMPRESSORS, ChunkedArray
from deodar.recording.provenance import KEY
from deodar.recording.record import time_dimension
from deodar.recording.slabs import slabs

SUFFIXES = {"zarr": ".zarr", "netcdf": ".nc", "csv": ".csv"}
"""Formats and their file name endings."""

SHARE = 0.8
"""Share of the free memory that a record may fill when it is read."""


def save_record(
    data: xarray.Dataset, path: str | Path, format: str | None = None, force: bool = False
) -> Path:
    """Write a record.

    Args:
        data: the record, as `simulate` returns it.
        path: the file; its folder must exist.
        format: zarr (a folder, version 3), netcdf (NetCDF 3) or csv (one row for each time, trial, sweep
            point and sample, its metadata in NAME.csv-metadata.json; not read back). None: given by the
            ending of the name: .zarr, .nc or .csv.
        force: whether to replace an existing record.

    Raises:
        OutputExists: the path exists; with `force`: it exists and is not a record.
        OutputError: the record cannot be written.
    """
    path = Path(path)
    kind = format_of(path, format)
    if not isinstance(data, xarray.Dataset):
        raise RecordError(
            f"a record is an xarray.Dataset, not {type(data).__name__}",
            fix="A single variable: dd.save_record(data[['u.activation']], path)",
        )
    claim(path, kind, force)
    if kind == "csv":
        output.write(path, lambda beside: table.write(data, beside))
        output.write(table.beside(path), table.metadata(data, path.name).encode())
    elif kind == "netcdf":
        output.write(path, lambda beside: _write_netcdf(data, beside))
    else:
        places.write_folder(path, lambda beside: _write_zarr(data, beside), force)
    return path


def format_of(path: Path, format: str | None = None) -> str:
    """Return the requested format, given by name or by the ending of the file name."""
    if format is not None:
        if format not in SUFFIXES:
            raise RecordError(f"there is no format {format!r}", fix=did_you_mean(format, SUFFIXES))
        return format
    kinds = [kind for kind, suffix in SUFFIXES.items() if path.suffix.lower() == suffix]
    if not kinds:
        raise RecordError(
            f"the name ends in {path.suffix or 'nothing'!r}, which names no format",
            where=str(path),
            fix="End it in .zarr, .nc or .csv",
        )
    return kinds[0]


def claim(path: Path, format: str, force: bool = False) -> None:
    """Refuse a path that may not be written; with `force` an existing record may be replaced."""
    if format != "zarr":
        output.claim(path, force)
        if format == "csv":
            output.claim(table.beside(path), force)
        return
    places.claim_folder(path, force)
    if path.is_dir() and not is_zarr(path):
        raise OutputExists("exists and is not a record", where=str(path), fix="Choose another name")


def load_record(path: str | Path) -> xarray.Dataset:
    """Read a record: a Zarr folder, a NetCDF file, or a folder that `deodar run` wrote.

    Raises:
        RecordError: the record does not exist, or was not written by deodar.
        DamagedFile: it is damaged, and nothing of it can be read.
        TooLarge: the record does not fit into memory.

    Warns:
        RunWarning: a part of it is missing or damaged, and left out; the attribute `damaged` says so, too.
    """
    with _reading(path := Path(path)), _opened(*locate(path)) as stored:
        need, free = stored.nbytes, psutil.virtual_memory().available
        if need > SHARE * free:
            raise TooLarge(
                f"needs {need / 2**30:,.1f} GiB of memory and {free / 2**30:,.1f} GiB are free",
                fix="Open it with dd.open_record, which reads only what is used",
            )
        _require_record(stored)
        try:
            whole = stored.load()
        except (MemoryError, OSError):
            raise
        except Exception:  # libraries that read untrusted bytes may raise any exception
            whole = sound.readable(stored).load()
        record = portable.unpack(whole)
        record.encoding["source"] = str(locate(path)[0])
    _warn_of_damage(record, path)
    return record


def open_record(path: str | Path) -> xarray.Dataset:
    """Open a record without reading its values: each variable reads what is selected from it.

    `open_record(path)["u.activation"].sel(time=500).values` reads the chunk of that time alone, so a record
    may be larger than the memory. What is read is compared with its checksums: a damaged chunk raises
    `DamagedFile` when it is read.

    Args:
        path: a Zarr folder, a NetCDF file, or a folder that `deodar run` wrote.

    Raises:
        RecordError: the record does not exist, or was not written by deodar.
        DamagedFile: what it states about itself is damaged.

    Warns:
        RunWarning: a chunk of it is missing; the samples from there on are left out.
    """
    record = opened(path)
    _warn_of_damage(record, Path(path))
    return record


def opened(path: str | Path) -> xarray.Dataset:
    """Return a record as `open_record` does, without a warning: its attribute `damaged` says what is left
    out.
    """
    with _reading(path := Path(path)):
        place, kind = locate(path)
        record = portable.unpack(_require_record(_opened(place, kind)), lazily=True)
        record.encoding["source"] = str(place)
        return record


def _warn_of_damage(record: xarray.Dataset, path: Path) -> None:
    if text := record.attrs.get(sound.DAMAGED):
        warnings.warn(f"{path}: {text}", RunWarning, stacklevel=3)


@contextlib.contextmanager
def _reading(path: Path) -> Generator[None]:
    """Convert every error into one that names the record."""
    try:
        yield
    except DeodarError as error:
        problems = [Problem(p.where or str(path), p.what, p.fix) for p in error.problems]
        raise type(error)(problems) from None
    except MemoryError:
        raise TooLarge("does not fit into memory", where=str(path)) from None
    except Exception as error:  # libraries that read untrusted bytes may raise any exception
        text = " ".join(str(error).split())[:200]
        raise RecordError(
            f"cannot be read as a record, it may be damaged ({type(error).__name__}: {text})", where=str(path)
        ) from None


def _require_record(record: xarray.Dataset) -> xarray.Dataset:
    if KEY not in record.attrs and portable.KEY not in record.attrs:
        raise RecordError("is not a record of deodar: it does not state the model that made it")
    return record


def locate(path: Path) -> tuple[Path, str]:
    """Return the path of the record that a path names, and its format."""
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        suggestion = (
            did_you_mean(path.name, [p.name for p in path.parent.iterdir()]) if path.parent.is_dir() else ""
        )
        raise RecordError(
            "there is no such record", fix=suggestion if suggestion.startswith("Did") else ""
        ) from None
    except (OSError, ValueError) as error:
        raise RecordError(f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if stat.S_ISDIR(mode):
        for inner, kind in ((path, "zarr"), (path / "record.zarr", "zarr"), (path / "record.nc", "netcdf")):
            if (kind == "zarr" and (inner / "zarr.json").is_file()) or (kind == "netcdf" and inner.is_file()):
                return inner, kind
        if (path / "record.csv").is_file():
            path = path / "record.csv"
        else:
            raise RecordError(
                "is a folder without a record in it",
                fix="Name a record (.zarr, .nc) or a folder that deodar run wrote",
            )
    if not path.is_file():
        raise RecordError("is neither a file nor a folder")
    if path.suffix.lower() == ".csv":
        raise RecordError(
            "is a table for other programs, and is not read back",
            fix="Write records as .zarr or .nc to plot or repeat them",
        )
    with regular_file.open_binary(path) as file:
        start = file.read(8)
    if start[:3] == b"CDF":
        return path, "netcdf"
    if start == b"\x89HDF\r\n\x1a\n":
        raise RecordError("is a NetCDF 4 (HDF5) file; deodar writes and reads NetCDF 3 and Zarr")
    raise RecordError(
        "is not a record", fix="A record is a .zarr folder, a .nc file, or a folder that deodar run wrote"
    )


def is_record(path: Path) -> bool:
    """Return whether a path looks like a readable record, without reading it."""
    try:
        locate(path)
        return True
    except RecordError as error:
        return "table for other programs" in str(error)


def grows(path: Path) -> bool:
    """Return whether a record was written during its run, so that it can be resumed."""
    place, kind = locate(path)
    return kind == "zarr" and '\\"grows\\"' in regular_file.read_text(place / "zarr.json")


def is_zarr(path: Path) -> bool:
    """Return whether a folder is a Zarr record of deodar."""
    try:
        text = regular_file.read_text(path / "zarr.json")
        return f'"{portable.KEY}"' in text or f'"{KEY}"' in text
    except (OSError, ValueError):
        return False


# ---------------------------------------------------------------------------------------------------- formats


def _write_zarr(record: xarray.Dataset, path: Path) -> None:
    with warnings.catch_warnings():
        # other programs open a record at once, and without a warning, if its metadata are in one file
        warnings.filterwarnings("ignore", message="Consolidated metadata")
        stored = portable.pack(record, narrow=False)
        encoding: dict[Any, Any] = {name: {"chunks": shape} for name, shape in _frame_chunks(stored).items()}
        sources = portable.sources(record, stored)
        for name in stored.variables:
            encoding.setdefault(name, {})["compressors"] = COMPRESSORS
        # Zarr leaves out chunks of its fill value; all chunks are written below
        unset = {n: np.full((), np.nan if v.dtype.kind == "f" else 0, v.dtype) for n, v in stored.items()}
        hollow = stored.copy(data={n: np.broadcast_to(v, stored[n].shape) for n, v in unset.items()})
        hollow.to_zarr(path, mode="w", zarr_format=3, consolidated=True, encoding=encoding)
    for name, metadata in group_file.prove(path)["consolidated_metadata"]["metadata"].items():
        array, variable = ChunkedArray(path / name, metadata), sources[name]
        for slab in slabs(variable.shape, portable.BLOCK):
            array.store([part.start for part in slab], variable[slab].values)


def _frame_chunks(stored: xarray.Dataset) -> dict[Any, tuple[int, ...]]:
    """Return chunks of whole frames of one copy, so that one moment of a long record is read at once."""
    names = codec.parse(stored.attrs[portable.KEY])["names"]
    chunks: dict[Any, tuple[int, ...]] = {}
    for name, variable in stored.data_vars.items():
        dims = [names.get(str(d), str(d)) for d in variable.dims]
        time = time_dimension(xarray.DataArray(np.empty((0,) * len(dims)), dims=dims))
        if time is not None and variable.size:
            lead = dict.fromkeys(dims[: dims.index(time)], 1)
            frames = growing.frame_chunks(variable, dims, time, lead)
            chunks[name] = tuple(min(n, c) for n, c in zip(variable.shape, frames, strict=True))
    return chunks


def _write_netcdf(record: xarray.Dataset, path: Path) -> None:
    for name, variable in record.variables.items():
        if variable.nbytes > netcdf.LARGEST:
            raise RecordError(
                f"needs {variable.nbytes / 2**30:.1f} GiB; NetCDF 3 holds 4",
                where=str(name),
                fix="Save it as .zarr",
            )
    stored = portable.pack(record, narrow=True)
    readers: dict[str, netcdf.ReadSlab] = {
        name: lambda slab, whole=whole: whole[slab].values
        for name, whole in portable.sources(record, stored).items()
    }
    netcdf.write(stored, readers, path)


def _opened(path: Path, kind: str) -> xarray.Dataset:
    if kind == "netcdf":
        stored = netcdf.read(path)
        portable.require_proof(stored.attrs, portable.PROOF in stored.attrs)
        return stored
    # the metadata of the group commit a record that grows; records of earlier versions may lack them
    group = group_file.read(path)
    stored = lazy.opened(path, group)
    if stored is None:
        consolidated = "metadata" in group.get("consolidated_metadata", {})
        stored = xarray.open_zarr(
            path, zarr_format=3, consolidated=consolidated, decode_cf=False, chunks=None
        )
    return sound.present(stored, path)
