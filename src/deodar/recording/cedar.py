"""Records as cedar's recorder writes them: one CSV file for each variable, one time in each row.

The first line is `Mat,CV_32F,ROWS,COLUMNS`, with the number of samples along each axis (`CV_64F` in double
precision). Each other line begins with the time in seconds, `0.02 s`; the values follow, of which those along
the first axis are beside each other. cedar writes six digits; deodar writes as many as the value has.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray

from deodar.errors import RecordError
from deodar.model.unit import unit_seconds
from deodar.recording import places
from deodar.recording.record import time_dimension
from deodar.recording.slabs import slabs

BLOCK = 2**22
"""Number of values that are read at a time."""

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


def _seconds(name: str, variable: xarray.DataArray) -> float:
    """Return the seconds in one unit of the times of a variable."""
    time = time_dimension(variable)
    if time is None:
        raise RecordError("has no times", where=name, fix="Name the variables that have some")
    unit = str(variable[time].attrs.get("units", "ms"))
    if unit == "abstract":
        raise RecordError("has abstract times, and cedar writes seconds", where=name, fix="Type: --to csv")
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
