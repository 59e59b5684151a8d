"""Records as cedar's recorder writes them, in and out: one CSV file for each variable, one time in each row.

The first line is `Mat,CV_32F,ROWS,COLUMNS`, with the number of samples along each axis (`CV_64F` in double
precision). Each other line begins with the time in seconds, `0.02 s`; the values follow, of which those along
the first axis are beside each other. cedar writes six digits; deodar writes as many as the value has.
"""

from __future__ import annotations

import math
import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import regular_file
from deodar.errors import Fix, RecordError
from deodar.model.unit import unit_seconds
from deodar.recording import places
from deodar.recording.record import time_dimension
from deodar.recording.slabs import slabs

BLOCK = 2**22
"""Number of values that are read at a time."""

AXES = ("x", "y", "z", "w")
MOST = 1_000_000
"""Largest number of samples along an axis; more are an error of the file."""

STAMP = re.compile(r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?) ?s")
"""A time as cedar writes it: `0.02 s`."""

LEAST_AXES = 2
"""Number of sizes in the first line, at least; a line of n samples has the sizes n and 1."""


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record as a folder of CSV files, as cedar's recorder does.

    A file has the path of its variable as its name. Each trial and each point of a sweep has a folder of its
    own, `Trial_0` or `u.tau=10/Trial_0`.

    Args:
        data: the record; it is read in blocks.
        path: the folder.
        force: whether to replace an existing folder.

    Raises:
        RecordError: a variable has no time, or its unit of time is not in seconds.
        OutputExists: the folder exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    path = Path(path)
    for name, variable in data.data_vars.items():
        _seconds(str(name), variable)
    places.claim_folder(path, force)

    def fill(folder: Path) -> None:
        for name, variable in data.data_vars.items():
            for place, one in _copies(variable):
                below = folder.joinpath(*place)
                below.mkdir(parents=True, exist_ok=True)
                _write(one, _seconds(str(name), variable), _free(below, str(name)))

    places.write_folder(path, fill, force)
    return path


def load_cedar(path: str | Path) -> xarray.Dataset:
    """Read what cedar's recorder wrote: a folder of CSV files, or one of them.

    Variables have the names of the files, of files in folders inside with the folder, `Trial_1/u_activation`.
    Their dimensions are a time in ms and `AXIS of VARIABLE`, whose axes are x, y, z and w with samples at 0,
    1, 2, ... Variables that were recorded at the same times share `time`; others have `time of VARIABLE`.

    Args:
        path: the folder, or a CSV file.

    Raises:
        RecordError: there is no such file, a folder has none, or a file is not as cedar writes it; the error
            states the line.
    """
    path = Path(path)
    files = (
        [path] if regular_file.is_file(path) else sorted(path.rglob("*.csv")) if os.path.isdir(path) else []
    )
    if not files:
        raise RecordError("is neither a CSV file nor a folder with some", where=str(path))
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for file in files:
        name = file.stem if file == path else file.relative_to(path).with_suffix("").as_posix()
        found[name] = _read(file)
    shared = Counter(times.tobytes() for times, _ in found.values()).most_common(1)[0][0]
    variables: dict[str, Any] = {}
    coords: dict[str, Any] = {}
    for name, (times, values) in found.items():
        time = "time" if times.tobytes() == shared else f"time of {name}"
        dims = [f"{axis} of {name}" for axis, _ in zip(AXES, values.shape[1:], strict=False)]
        coords[time] = (time, times, {"units": "ms"})
        coords |= {d: (d, np.arange(n, dtype=float)) for d, n in zip(dims, values.shape[1:], strict=True)}
        variables[name] = ([time, *dims], values)
    return xarray.Dataset(variables, coords, {"title": path.stem})


def _read(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the times in ms and the values of one file, without axes of one sample.

    Raises:
        RecordError: it is not as cedar writes it.
    """
    try:
        lines = regular_file.read_text(path).splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"cannot be read: {error}", where=str(path)) from None
    head = [w.strip() for w in lines[0].split(",")] if lines else []
    sizes = [int(w) for w in head[2:] if w.isdigit() and 0 < int(w) <= MOST]
    if len(head) < 3 or head[0] != "Mat" or len(sizes) < len(head) - 2 or len(sizes) > len(AXES):
        raise RecordError(
            "is not a file of cedar's recorder",
            where=str(path),
            fix="Its first line is Mat,CV_32F,ROWS,COLUMNS",
        )
    times: list[float] = []
    rows: list[list[float]] = []
    for number, line in enumerate(lines[1:], 2):
        words = line.split(",")
        stamp = STAMP.fullmatch(words[0].strip())
        try:
            row = [float(w) for w in words[1:]]
        except ValueError:
            row = []
        if stamp is None or len(row) != math.prod(sizes):
            if number == len(lines):
                break  # the last line of a recording that was cut off
            raise RecordError(
                f"line {number} is not a time in seconds and {math.prod(sizes)} numbers", where=str(path)
            )
        times.append(1000 * float(stamp[1]))
        rows.append(row)
    kept = [n for n in sizes if n > 1] if len(sizes) <= LEAST_AXES else sizes
    values = np.array(rows, float).reshape(len(rows), *reversed(sizes))
    values = np.transpose(values, (0, *range(len(sizes), 0, -1)))
    return np.array(times), values.reshape(len(rows), *kept)


def _seconds(name: str, variable: xarray.DataArray) -> float:
    """Return the seconds in one unit of the times of a variable."""
    time = time_dimension(variable)
    if time is None:
        raise RecordError("has no times", where=name, fix="Name the variables that have some")
    unit = str(variable[time].attrs.get("units", "ms"))
    if unit == "abstract":
        raise RecordError(
            "has abstract times, and cedar writes seconds",
            where=name,
            fix=Fix("Save it as .csv", "Type: --to csv"),
        )
    return unit_seconds(unit)


def _copies(variable: xarray.DataArray) -> Iterator[tuple[list[str], xarray.DataArray]]:
    """Yield the parts of the name of a folder, and the variable, of each point of a sweep and each trial."""
    time = time_dimension(variable)
    dims = list(map(str, variable.dims))
    lead = dims[: dims.index(str(time))]
    for index in np.ndindex(*(variable.sizes[d] for d in lead)):
        parts = [
            f"Trial_{variable[d].values[k]}" if d == "trial" else _plain(f"{d}={variable[d].values[k]:g}")
            for d, k in zip(lead, index, strict=True)
        ]
        yield parts, variable.isel(dict(zip(lead, index, strict=True)))


def _write(one: xarray.DataArray, seconds: float, path: Path) -> None:
    """Write one file: times, then axes."""
    shape = one.shape[1:]
    wide = one.dtype == np.float64
    sizes = [*shape, *[1] * (LEAST_AXES - len(shape))]
    times = (np.asarray(one[str(one.dims[0])].values, float) * seconds).round(12)
    with path.open("w", newline="", encoding="ascii") as file:
        file.write(f"Mat,{'CV_64F' if wide else 'CV_32F'},{','.join(map(str, sizes))}\n")
        for (part,) in slabs(one.shape[:1], max(1, BLOCK // math.prod(shape))):
            rows = one[part].values.astype(np.float64 if wide else np.float32)
            for time, values in zip(times[part], rows, strict=True):
                texts = np.reshape(values, -1, order="F").astype(str).tolist()
                file.write(f"{_short(time)} s,{','.join(texts)}\n")


def _short(time: float) -> str:
    """Return the shortest text of a number."""
    return f"{time:g}" if float(f"{time:g}") == time else repr(float(time))


def _plain(text: str) -> str:
    """Return a text that every file system can hold as a name."""
    return re.sub(r"[^\w.=+-]+", "_", text)[:100] or "_"


def _free(folder: Path, name: str) -> Path:
    """Return an unused name for a variable: two may differ in what no file name can hold."""
    path, n = folder / f"{_plain(name)}.csv", 1
    while path.exists():
        n += 1
        path = folder / f"{_plain(name)}_{n}.csv"
    return path
