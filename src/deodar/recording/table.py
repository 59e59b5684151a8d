"""A record as one long table in CSV, for other programs: one row for each sweep point, trial, time and sample."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import xarray

ROWS = 100_000
"""Rows that are made at a time: memory does not grow with the record."""


def write(data: xarray.Dataset, path: Path) -> None:
    """Write the table.

    Lines that begin with `# ` come first: the title, units, and what made the record, as JSON. Then one line of names and the rows.
    Variables over the same dimensions share rows; a row leaves the columns empty that do not belong to it.
    """
    blocks: dict[tuple[str, ...], list[str]] = {}
    for name, variable in data.data_vars.items():
        blocks.setdefault(tuple(map(str, variable.dims)), []).append(str(name))
    dims = list(dict.fromkeys(d for block in blocks for d in block))
    columns = [*dims, *(name for names in blocks.values() for name in names)]
    place = {name: k for k, name in enumerate(columns)}
    with path.open("w", newline="", encoding="utf-8") as file:
        for line in _head(data):
            file.write(f"# {line}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for block, names in blocks.items():
            shape = tuple(data.sizes[d] for d in block)
            arrays = {name: np.ascontiguousarray(data[name].values).reshape(-1) for name in names}
            size = int(np.prod(shape, dtype=np.int64))
            for start in range(0, size, ROWS):
                rows = slice(start, min(start + ROWS, size))
                index = np.unravel_index(np.arange(rows.start, rows.stop), shape) if shape else ()
                cells: list[Any] = [[""] * (rows.stop - rows.start)] * len(columns)
                for dim, i in zip(block, index, strict=True):
                    cells[place[dim]] = _text(data[dim].values[i] if dim in data.coords else i)
                for name, array in arrays.items():
                    cells[place[name]] = _text(array[rows])
                writer.writerows(zip(*cells, strict=True))


def _head(data: xarray.Dataset) -> list[str]:
    lines = [f"title: {data.attrs['title']}"] if data.attrs.get("title") else []
    lines += [f"unit of {name}: {v.attrs['units']}" for name, v in data.variables.items() if v.attrs.get("units")]
    lines += [f"{key}: {value}" for key, value in data.attrs.items() if key != "title"]
    return [" ".join(line.splitlines()) for line in lines]


def _text(array: np.ndarray) -> list[str]:
    """The shortest text that gives the same number again in the array's own precision."""
    return array.astype(str).tolist()
