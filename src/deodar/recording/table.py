"""A record as one long table in CSV, for other programs.

The table has one row for each sweep point, trial, time and sample.

It consists of a line of names and the rows: `pandas.read_csv(path)` reads it. Its metadata (title, units,
provenance) are in `NAME.csv-metadata.json`, in the form of the W3C's Metadata Vocabulary for Tabular Data
(2015), section 5.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.recording.slabs import slabs

ROWS = 100_000
"""Number of rows that are made at a time, so that memory does not grow with the record."""


def write(record: xarray.Dataset, path: Path) -> None:
    """Write the table.

    Variables over the same dimensions share rows; columns that do not belong to a row are empty.
    """
    blocks = _blocks(record)
    columns = _columns(blocks)
    place = {name: k for k, name in enumerate(columns)}
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for block, names in blocks.items():
            shape = tuple(record.sizes[d] for d in block)
            points = [record[d].values if d in record.coords else np.arange(record.sizes[d]) for d in block]
            for slab in slabs(shape, ROWS):
                index = np.indices([part.stop - part.start for part in slab]).reshape(len(shape), -1)
                rows = index.shape[1] if shape else 1
                cells: list[Any] = [[""] * rows] * len(columns)
                for dim, values, i, part in zip(block, points, index, slab, strict=True):
                    cells[place[dim]] = _text(values[part.start + i])
                for name in names:
                    cells[place[name]] = _text(np.ravel(record[name][slab].values))
                writer.writerows(zip(*cells, strict=True))


def beside(path: Path) -> Path:
    """Return the path of a table's metadata, where programs expect such metadata."""
    return path.with_name(f"{path.name}-metadata.json")


def metadata(record: xarray.Dataset, name: str) -> str:
    """Return the metadata of the table of that file name, as JSON: title, columns with units, and the
    provenance as notes.
    """
    columns: list[dict[str, str]] = []
    for column in _columns(_blocks(record)):
        attributes: dict[str, Any] = dict(record[column].attrs) if column in record.variables else {}
        kind = record[column].dtype if column in record.variables else np.dtype(np.int64)
        description = {"titles": column, "datatype": _datatype(kind)}
        description |= {"dc:description": str(attributes["long_name"])} if attributes.get("long_name") else {}
        description |= {"schema:unitText": str(attributes["units"])} if attributes.get("units") else {}
        columns.append(description)
    title = {"dc:title": str(record.attrs["title"])} if record.attrs.get("title") else {}
    notes = {
        str(key): value if isinstance(value, str) else str(value)
        for key, value in record.attrs.items()
        if key != "title"
    }
    table = {
        "@context": "http://www.w3.org/ns/csvw",
        "url": name,
        **title,
        "tableSchema": {"columns": columns},
        "notes": [notes],
    }
    return codec.text(table) + "\n"


def _blocks(record: xarray.Dataset) -> dict[tuple[str, ...], list[str]]:
    """Return the names of the variables, by their dimensions."""
    blocks: dict[tuple[str, ...], list[str]] = {}
    for name, variable in record.data_vars.items():
        blocks.setdefault(tuple(map(str, variable.dims)), []).append(str(name))
    return blocks


def _columns(blocks: dict[tuple[str, ...], list[str]]) -> list[str]:
    dims = list(dict.fromkeys(d for block in blocks for d in block))
    return [*dims, *(name for names in blocks.values() for name in names)]


def _datatype(kind: np.dtype[Any]) -> str:
    """Return the vocabulary's name of a type of numbers."""
    if kind == np.float32:
        return "float"
    return {"f": "double", "i": "integer", "u": "integer", "b": "boolean"}.get(kind.kind, "string")


def _text(array: np.ndarray) -> list[str]:
    """Return the shortest text that gives the same number in the array's own precision."""
    return array.astype(str).tolist()
