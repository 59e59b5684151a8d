"""The values of MATLAB as NumPy arrays of at least two dimensions.

Numbers are arrays of floats or booleans, text is an array of characters, a cell array is an array of objects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np

from deodar_interop.importers.cosivina.launchers.expressions import NotRead

MOST_ENTRIES = 2_000_000
"""Most entries of one array."""


def number(value: float) -> np.ndarray:
    """Return a number as an array."""
    return np.full((1, 1), float(value))


def flag(value: bool) -> np.ndarray:
    """Return a truth value as an array."""
    return np.full((1, 1), value)


def text(value: str) -> np.ndarray:
    """Return a text as an array of characters; an empty one has no rows."""
    return np.array(list(value), dtype="<U1").reshape(1 if value else 0, len(value))


def cells(values: Sequence[Any], column: bool = False) -> np.ndarray:
    """Return values as a row or a column of cells."""
    out = np.empty(len(values), dtype=object)
    for k, value in enumerate(values):
        out[k] = value
    return out.reshape((-1, 1) if column else (1, -1))


def is_text(value: Any) -> bool:
    """Return whether a value is text."""
    return isinstance(value, np.ndarray) and value.dtype.kind == "U"


def is_cells(value: Any) -> bool:
    """Return whether a value is a cell array."""
    return isinstance(value, np.ndarray) and value.dtype == object


def is_numbers(value: Any) -> bool:
    """Return whether a value is an array of numbers."""
    return isinstance(value, np.ndarray) and value.dtype.kind in "fb"


def require_size(count: float) -> None:
    """Raise an error if an array would have too many entries."""
    if not count <= MOST_ENTRIES:
        raise NotRead(f"an array of more than {MOST_ENTRIES} entries is not read")


def string(value: Any) -> str:
    """Return a text of one row."""
    if is_text(value) and (value.size == 0 or (value.ndim == 2 and value.shape[0] == 1)):
        return "".join(value.reshape(-1).tolist())
    raise NotRead(f"a text is expected, not {described(value)}")


def strings(value: Any) -> list[str]:
    """Return texts: of a cell array each cell, of a text its rows without the space behind them."""
    if is_cells(value):
        return [string(cell) for cell in value.reshape(-1, order="F")]
    if is_text(value):
        return ["".join(row).rstrip() for row in value.tolist()] if value.size else []
    if is_numbers(value) and value.size == 0:
        return []
    raise NotRead(f"names are expected, not {described(value)}")


def names_of(value: Any) -> list[str]:
    """Return texts as `strings` does; an empty cell is an empty text, as an empty list of numbers is."""
    if is_cells(value):
        return [
            "" if is_numbers(cell) and cell.size == 0 else string(cell)
            for cell in value.reshape(-1, order="F")
        ]
    return [string(value)] if is_text(value) and value.shape[0] == 1 else strings(value)


def real(value: Any) -> float:
    """Return the number of an array that has one."""
    if is_numbers(value) and value.size == 1:
        return float(value.reshape(-1)[0])
    raise NotRead(f"a number is expected, not {described(value)}")


def whole(value: Any, least: float = -1e9, most: float = 1e9) -> int:
    """Return the whole number of an array that has one, within bounds."""
    plain = real(value)
    if not (least <= plain <= most and plain == math.floor(plain)):
        raise NotRead(f"{plain:g} is not a whole number from {least:g} to {most:g}")
    return int(plain)


def numbers(value: Any) -> np.ndarray:
    """Return an array as floats; the characters of a text as their codes."""
    if is_text(value):
        return np.array([ord(c) for c in value.reshape(-1).tolist()], dtype=float).reshape(value.shape)
    if not is_numbers(value):
        raise NotRead(f"numbers are expected, not {described(value)}")
    return value.astype(float)


def is_true(value: Any) -> bool:
    """Return whether a condition holds: an array without a zero that is not empty."""
    array = numbers(value)
    return array.size > 0 and bool((array != 0).all())


def described(value: Any) -> str:
    """Return what a value is, for messages."""
    if is_text(value):
        return f"the text {''.join(value.reshape(-1).tolist())[:40]!r}"
    if is_cells(value):
        return f"{value.size} cells"
    if is_numbers(value):
        return f"{float(value.reshape(-1)[0]):g}" if value.size == 1 else f"{value.size} numbers"
    return type(value).__name__


def joined(rows: Sequence[Sequence[Any]]) -> np.ndarray:
    """Return the matrix that rows of arrays make; empty ones are left out."""
    values = [v for row in rows for v in row]
    if not all(isinstance(v, np.ndarray) for v in values):
        raise NotRead("objects are not joined")
    dtype, entry = _entries(values)
    parts = [[entry(v) for v in row if v.size] for row in rows]
    require_size(sum(v.size for row in parts for v in row))
    lines = [np.concatenate(row, axis=1) for row in parts if row]
    return np.concatenate(lines, axis=0) if lines else np.zeros((0, 0), dtype=dtype)


def _entries(values: Sequence[np.ndarray]) -> tuple[Any, Callable[[np.ndarray], np.ndarray]]:
    """Return the type of the matrix that arrays make, and the function that gives an array this type: a cell
    makes all of them cells, a text characters.
    """
    if any(is_cells(v) for v in values):
        return object, lambda v: v if is_cells(v) else cells([v])
    if any(is_text(v) for v in values):
        return "<U1", lambda v: v if is_text(v) else _characters(v)
    return float, lambda v: v.astype(float)


def _characters(value: np.ndarray) -> np.ndarray:
    codes = numbers(value)
    if not ((codes >= 0) & (codes < 0x110000)).all():
        raise NotRead("a number in a text is not the code of a character")
    return np.array([chr(int(c)) for c in codes.reshape(-1)], dtype="<U1").reshape(codes.shape)


def index_of(value: np.ndarray, indices: Sequence[Any]) -> np.ndarray:
    """Return the entries of an array at indices from 1; None is all of a dimension."""
    if len(indices) == 1:
        flat = value.reshape(-1, order="F")
        if indices[0] is None:
            return flat.reshape(-1, 1)
        places = _places(indices[0], flat.size)
        index = cast("np.ndarray", indices[0])
        if index.dtype == bool or (1 in value.shape[:2] and 1 in index.shape[:2] and value.ndim == 2):
            return flat[places.reshape(-1)].reshape((1, -1) if value.shape[0] == 1 else (-1, 1))
        return flat[places.reshape(-1, order="F")].reshape(index.shape, order="F")
    shape = (*value.shape, *(1,) * max(0, len(indices) - value.ndim))
    if len(indices) < len(shape):
        shape = (*shape[: len(indices) - 1], math.prod(shape[len(indices) - 1 :]))
    places = [
        np.arange(n) if k is None else _places(k, n).reshape(-1) for k, n in zip(indices, shape, strict=True)
    ]
    require_size(math.prod(len(p) for p in places))
    entries = value.reshape(shape, order="F")[np.ix_(*places)]
    while entries.ndim > 2 and entries.shape[-1] == 1:
        entries = entries[..., 0]
    return entries


def put_at(value: np.ndarray | None, indices: Sequence[Any], new: np.ndarray) -> np.ndarray:
    """Return an array with other entries at indices from 1; it grows as far as needed."""
    if value is None:
        value = np.empty((0, 0), dtype=new.dtype if new.dtype != bool else float)
    value, new = _alike(value, new)
    if len(indices) == 1:
        indices = _along(value, indices[0])
    shape = (*value.shape, *(1,) * max(0, len(indices) - value.ndim))
    if len(indices) < len(shape):
        raise NotRead("fewer indices than dimensions are not read")
    places = [
        np.arange(n or new.size) if k is None else _places(k, MOST_ENTRIES).reshape(-1)
        for k, n in zip(indices, shape, strict=True)
    ]
    grown = _grown(value, shape, [int(p.max()) + 1 if p.size else 0 for p in places])
    target = tuple(len(p) for p in places)
    filled = np.repeat(new.reshape(-1), math.prod(target)) if new.size == 1 else new.reshape(-1, order="F")
    grown[np.ix_(*places)] = filled.reshape(target, order="F")
    return grown


def _alike(value: np.ndarray, new: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return an array and its new entries with one type."""
    if value.dtype == new.dtype:
        return value, new
    if is_cells(value) or is_cells(new) or is_text(value) != is_text(new):
        if value.size or is_cells(value):
            raise NotRead("an array would have values of different kinds")
        return value.astype(new.dtype), new
    if value.dtype == bool and value.size:
        return value, new != 0
    return value.astype(float), new.astype(float)


def _grown(value: np.ndarray, shape: Sequence[int], least: Sequence[int]) -> np.ndarray:
    """Return a copy of an array, of a shape and as large as needed; its new cells are empty."""
    need = tuple(map(max, shape, least))
    require_size(math.prod(need))
    grown = np.full(need, "\0" if is_text(value) else 0, dtype=value.dtype)
    if is_cells(value):
        for k in np.ndindex(need):
            grown[k] = np.zeros((0, 0))
    grown[tuple(slice(0, n) for n in shape)] = value.reshape(shape)
    return grown


def without(value: np.ndarray, indices: Sequence[Any]) -> np.ndarray:
    """Return an array without the entries at indices from 1."""
    long = [d for d, k in enumerate(indices) if k is not None]
    if len(indices) == 1 and long:
        remaining = np.delete(value.reshape(-1, order="F"), _places(indices[0], value.size).reshape(-1))
        return remaining.reshape((-1, 1) if value.shape[0] > 1 and value.shape[1] == 1 else (1, -1))
    if len(long) != 1 or len(indices) > value.ndim:
        raise NotRead("only whole rows or columns are removed")
    (d,) = long
    return np.delete(value, _places(indices[d], value.shape[d]).reshape(-1), axis=d)


def _along(value: np.ndarray, index: Any) -> tuple[Any, Any]:
    """Return the two indices that one index of a vector means."""
    if value.ndim != 2 or min(value.shape) > 1:
        raise NotRead("an array that is not a vector is changed at one index")
    first = number(1)
    return (index, first) if value.shape[1] == 1 and value.shape[0] > 1 else (first, index)


def _places(index: Any, count: int) -> np.ndarray:
    """Return indices from 0."""
    if not is_numbers(index):
        raise NotRead(f"an index is a number, not {described(index)}")
    if index.dtype == bool:
        if index.size > count:
            raise NotRead("an index is beyond the end")
        return np.flatnonzero(index.reshape(-1, order="F"))
    if not ((index >= 1) & (index <= count) & (index == np.floor(index))).all():
        raise NotRead(f"an index is not a whole number from 1 to {count}")
    return index.astype(np.int64) - 1


def counted(first: float, step: float, last: float) -> np.ndarray:
    """Return a range: a row of numbers."""
    if not all(math.isfinite(v) for v in (first, step, last)):
        raise NotRead("a range is endless")
    if step == 0 or (last - first) / step < 0:
        return np.zeros((1, 0))
    count = math.floor((last - first) / step * (1 + 1e-12) + 1e-10) + 1
    require_size(count)
    return (first + step * np.arange(count)).reshape(1, -1)
