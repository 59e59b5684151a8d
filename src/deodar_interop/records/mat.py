"""Files of MATLAB (.mat): records written, arrays read.

A record becomes one variable of MATLAB for each of its arrays and coordinates, under a name that MATLAB
allows, and `contents`, a cell array with a row for each: the name, the path in deodar, the dimensions and the
unit.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import xarray

from deodar import regular_file
from deodar.errors import RecordError, UnknownName, did_you_mean
from deodar.guarded.guarded_file import GuardedFile
from deodar.model import output
from deodar.model.paths import display, split

LONGEST = 63
"""Number of characters of a name in MATLAB."""

MOST = 2**31 - 1
"""Number of bytes of a variable in the format of version 5."""

TABLE = "contents"
"""Name of the variable that lists the others."""


def save(data: xarray.Dataset, path: str | Path, force: bool = False) -> Path:
    """Write a record as a file of MATLAB, version 5.

    Args:
        data: the record.
        path: the file.
        force: whether to replace an existing file.

    Raises:
        RecordError: a variable is larger than such a file can hold.
        OutputExists: the file exists, and `force` is not given.
        OutputError: it cannot be written.
    """
    path = output.claim(path, force)
    taken = {TABLE}
    rows: list[list[Any]] = []
    arrays: dict[str, Any] = {}
    for name, variable in data.variables.items():
        if variable.nbytes > MOST:
            raise RecordError(
                f"needs {variable.nbytes / 2**30:.1f} GiB; a .mat file holds 2 in a variable",
                where=str(name),
                fix="Save it as .zarr, or select a part",
            )
        new = _free(str(name), taken)
        unit = str(variable.attrs.get("units", ""))
        rows.append([new, str(name), _cells(list(map(str, variable.dims))), unit])
        arrays[new] = _values(variable)
    table = np.empty((len(rows), 4), object)
    for k, row in enumerate(rows):
        table[k, :] = row
    arrays[TABLE] = table
    write(arrays, path)
    return path


def write(values: Mapping[str, Any], path: Path) -> None:
    """Write variables of MATLAB: arrays, lists of structures; an existing file is replaced.

    Raises:
        OutputError: the file cannot be written.
    """
    # only this format needs it
    from scipy.io import savemat

    options: Mapping[str, Any] = {"appendmat": False, "long_field_names": True, "oned_as": "row"}
    output.write(path, lambda beside: savemat(str(beside), dict(values), **options))


def load_mat(path: str | Path, name: str = "") -> np.ndarray:
    """Read an array from a file of MATLAB, for a `Pattern`, `Weights` or the weights at the start.

    A row or a column of MATLAB is an array of one dimension here.

    Args:
        path: the file, version 4 to 7 (`save -v7`).
        name: the variable; with dots a field of a structure, `results.weights`. In a file that cosivina's
            `saveComponentsToMat` wrote, an element and its component: `"field u".activation`. May be left
            out if the file holds one variable.

    Returns:
        The numbers, in double precision. `WeightMatrix` of cosivina has sources as rows, and
        `dd.Weights` targets: pass its transpose, `.T`.

    Raises:
        RecordError: the file cannot be read, or what is named is not an array of real numbers.
        UnknownName: the file holds no such variable.
    """
    regular_file.refuse_special(path, RecordError)
    return GuardedFile(RecordError, str(path)).call(array_of, str(path), name)


def array_of(path: str, name: str) -> np.ndarray:
    """Return what `load_mat` does; in a child process."""
    # only this format needs it
    from scipy.io import loadmat

    try:
        variables = loadmat(path, simplify_cells=True)
    except NotImplementedError:
        raise RecordError(
            "is a file of MATLAB 7.3", where=path, fix="Save it in MATLAB with: save(NAME, '-v7')"
        ) from None
    except MemoryError:
        raise
    except Exception as error:  # a damaged file may raise any exception
        what = getattr(error, "strerror", None) or "it is not a file of MATLAB, or damaged"
        raise RecordError(f"cannot be read: {what}", where=path) from None
    held = _components({k: v for k, v in variables.items() if not k.startswith("__")})
    if not name and len(held) != 1:
        raise RecordError(f"holds {', '.join(held) or 'nothing'}", where=path, fix="Name one of them")
    value: Any = held
    steps = split(name) if name else list(held)
    for k, step in enumerate(steps):
        if not isinstance(value, dict) or step not in value:
            known = (
                [display([*steps[:k], key]) for key in cast("dict[str, Any]", value)]
                if isinstance(value, dict)
                else []
            )
            raise UnknownName(f"{path} holds no {display(steps[: k + 1])!r}", fix=did_you_mean(name, known))
        value = cast("dict[str, Any]", value)[step]
    if np.iscomplexobj(value) and np.any(np.imag(value)):
        raise RecordError(
            f"{display(steps)} holds complex numbers",
            where=path,
            fix="Save its real part, its imaginary part or its magnitude in MATLAB: real(A), imag(A), abs(A)",
        )
    try:
        return np.asarray(np.real(value) if np.iscomplexobj(value) else value, np.float64)
    except (TypeError, ValueError):
        raise RecordError(f"{display(steps)} is not an array of numbers", where=path) from None


def _components(held: Mapping[str, Any]) -> dict[str, Any]:
    """Return the variables; elements of cosivina, a list of structures with labels, by their labels."""
    out = dict(held)
    listed = out.get("elements")
    elements = [listed] if isinstance(listed, dict) else listed
    if not isinstance(elements, (list, np.ndarray)):
        return out
    labelled = {
        str(e["label"]): e for e in cast("Sequence[Any]", elements) if isinstance(e, dict) and "label" in e
    }
    if not labelled:
        return out
    del out["elements"]
    return out | labelled


def _values(variable: xarray.Variable) -> Any:
    """Return the values as MATLAB holds them: numbers, or a cell array of text."""
    values = variable.values
    if values.dtype.kind in "biufc":
        return values
    return _cells([str(v) for v in values.reshape(-1)]).reshape(values.shape or (1,))


def _cells(texts: Sequence[str]) -> np.ndarray:
    out = np.empty(len(texts), object)
    out[:] = texts
    return out


def _free(name: str, taken: set[str]) -> str:
    """Return an unused name that MATLAB allows."""
    plain = re.sub(r"\W", "_", name, flags=re.ASCII)[: LONGEST - 4]
    plain = plain if re.match(r"[A-Za-z]", plain) else f"v_{plain}"
    new, n = plain, 1
    while new in taken:
        n += 1
        new = f"{plain}_{n}"
    taken.add(new)
    return new
