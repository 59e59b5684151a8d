"""A list of points for a sweep, as a file: a CSV table, or JSON."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from deodar import codec, regular_file
from deodar.errors import DocumentError, reading

MOST_NUMBERS = 10**6
"""Largest number of values in a table (a guess, a hundred times the largest known sweep)."""


def read(path: str | Path) -> list[dict[str, float]]:
    """Read a list of points.

    A .csv file has a line of parameter paths, then one of numbers for each point; every other file is the
    list as JSON. `simulate` checks the values.

    Args:
        path: the file.

    Raises:
        DocumentError: it cannot be read, or is no such table or JSON.
    """
    path = Path(path)
    with reading(path, DocumentError):
        try:
            text = regular_file.read_text(path, "utf-8-sig")
        except UnicodeDecodeError:
            raise DocumentError("is not text in UTF-8") from None
        return _table(text) if path.suffix.lower() == ".csv" else _listed(text)


def _listed(text: str) -> list[dict[str, float]]:
    points: Any = codec.read(text)
    if not isinstance(points, list):
        raise DocumentError("is no list of points", fix='For example [{"u.tau": 10}, {"u.tau": 20}]')
    return points


def _table(text: str) -> list[dict[str, float]]:
    values = text.count(",") + text.count("\n")
    if values > MOST_NUMBERS:
        raise DocumentError(f"holds about {values:,} values; at most {MOST_NUMBERS:,} are read")
    try:
        rows = [row for row in csv.reader(text.splitlines()) if row]
    except csv.Error as error:
        raise DocumentError(f"is not a table in CSV: {error}") from None
    if not rows:
        raise DocumentError("is empty; the first line has the parameter paths", fix="For example u.tau,n.tau")
    paths = [cell.strip() for cell in rows[0]]
    if len(set(paths)) < len(paths):
        raise DocumentError(f"names a path twice: {', '.join(paths)}")
    points: list[dict[str, float]] = []
    for number, row in enumerate(rows[1:]):
        try:
            points.append({path: float(cell) for path, cell in zip(paths, row, strict=True)})
        except ValueError:
            raise DocumentError(
                f"point {number} is {','.join(row)}; expected one number for each of {', '.join(paths)}"
            ) from None
    return points
