"""The folder of a run: its record, and the model that made it."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import xarray

from deodar.errors import DeodarError, OutputExists
from deodar.model import document_files as documents
from deodar.model import output
from deodar.model.document import Document
from deodar.recording import files, places, table

MODEL = "model.json"


def record_name(format: str) -> str:
    """Return the name of the record inside a run's folder."""
    return f"record{files.SUFFIXES[format]}"


def claim(path: Path, format: str, force: bool = False) -> None:
    """Refuse, before a long run, a folder that cannot be written after it."""
    if path.is_symlink() or not path.is_dir():
        places.claim_folder(path)
        return
    output.require_replaceable(path, force)
    if files.is_zarr(path):
        raise OutputExists("is a record, not the folder of a run", where=str(path), fix="Choose another name")
    files.claim(path / record_name(format), format, force=True)
    places.require_parent(path / MODEL)
    model = path / MODEL
    if model.is_symlink() or (model.exists() and not model.is_file()):
        raise OutputExists("exists and is not a regular file", where=str(model), fix="Choose another name")


def growing(path: Path) -> Path:
    """Return the record that a run writes at a path: the path itself if it ends in .zarr, else one in this
    folder.
    """
    return path if path.suffix.lower() == files.SUFFIXES["zarr"] else path / record_name("zarr")


def claim_growing(path: Path, force: bool = False) -> None:
    """Refuse a path at which a growing record cannot begin."""
    if growing(path) == path:
        files.claim(path, "zarr", force)
    else:
        claim(path, "zarr", force)


def begin(doc: Document, path: Path, force: bool = False) -> Path:
    """Prepare the path of a record that will grow, and return that of the record; a replaced one is removed.

    A folder is created, with the model.

    Raises:
        OutputExists: the path exists; with `force`: it cannot be that of a run.
        OutputError: it cannot be written.
    """
    claim_growing(path, force)
    record = growing(path)
    if record == path:
        places.clear(path)
        return path
    new = not path.exists()
    try:
        path.mkdir(exist_ok=True)
        documents.save(doc, path / MODEL, force=True)
    except OSError as error:
        raise output.failed(path, error) from None
    except DeodarError:
        if new:
            places.clear(path)
        raise
    places.clear(record)
    _drop_others(path, "zarr")
    return record


def write(data: xarray.Dataset, doc: Document, path: Path, format: str, force: bool = False) -> Path:
    """Write record and model; a new folder is complete when it appears.

    In an existing folder only these two are replaced. Returns the record's path.
    """
    name = record_name(format)

    def fill(inner: Path) -> None:
        files.save_record(data, inner / name, format)
        documents.save(doc, inner / MODEL)

    if os.path.lexists(path):
        claim(path, format, force)
        files.save_record(data, path / name, format, force=True)
        documents.save(doc, path / MODEL, force=True)
        _drop_others(path, format)
        output.note(path)
    else:
        places.write_folder(path, fill)
    return path / name


def convert(path: Path, format: str) -> Path:
    """Replace the record of a run, a Zarr folder, by one in another format; return its path.

    Raises:
        OutputError: the system refused; the Zarr folder is still there.
        RecordError: the format cannot hold the record; the same.
    """
    record = files.load_record(path / record_name("zarr"))
    new = files.save_record(record, path / record_name(format), format)
    places.clear(path / record_name("zarr"))
    return new


def _drop_others(path: Path, format: str) -> None:
    """Remove the replaced run's record in another format: it does not belong to the new model in the
    folder.
    """
    for kind in files.SUFFIXES:
        old = path / record_name(kind)
        if kind == format or old.is_symlink():
            continue
        if old.is_dir() and files.is_zarr(old):
            shutil.rmtree(old)
        elif old.is_file():
            old.unlink()
            table.beside(old).unlink(missing_ok=True)
