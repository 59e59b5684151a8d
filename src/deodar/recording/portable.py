"""Convert a record to a form that every file format can store, and back without loss.

Formats differ in the names, types and attributes they allow. Arrays are stored under plain ASCII names, in
types that the format supports; one attribute lists the changes as JSON, with a hash of every array. Other
programs can read the file directly; deodar restores it exactly and detects damage.
"""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
import xarray

from deodar import codec, file_version
from deodar.errors import DamagedFile, RecordError
from deodar.recording.provenance import KEY as PROVENANCE
from deodar.recording.shown_dataset import ShownDataset
from deodar.recording.slabs import slabs

KEY = "deodar_layout"
"""Name of the attribute that lists the changes."""

VERSION = 3
"""Version of the layout; version 1, which stated none, had no arrays that grow."""

PROVEN = 3
"""First version whose files prove what they state: their metadata, and each chunk or block of an array."""

PROOF = "deodar_proof"
"""Name of the attribute with the SHA-256 of the metadata of a file."""

NO_PROOF = "0" * 64
"""Stands for the SHA-256 while it is computed."""

CHECKSUMS = "deodar_crc32c"
"""Name of the attribute of an array of a NetCDF file with the checksums of its blocks."""

OF_FILES = (KEY, PROOF, CHECKSUMS)
"""Attributes that belong to one file: a Dataset that another program opened has them, too."""

LONGEST = 100
RESERVED = frozenset(
    [
        "byte",
        "char",
        "short",
        "ushort",
        "int",
        "uint",
        "int64",
        "uint64",
        "float",
        "real",
        "double",
        "bool",
        "string",
    ]
)
"""Names that NetCDF does not allow."""

NARROW = tuple(map(np.dtype, ("f4", "f8", "i1", "i2", "i4")))
"""Types of numbers that NetCDF 3 has."""

WIDENED = {np.dtype("f2"): np.float32, np.dtype("?"): np.int8}
"""Types that hold the values of others, which NetCDF 3 does not have."""

EXACT_INTEGERS = 2**53

LARGE = 2**24
"""Number of bytes from which on an array is read in blocks."""

BLOCK = 2**22
"""Number of values of a block."""


def pack(record: xarray.Dataset, narrow: bool) -> xarray.Dataset:
    """Return a Dataset that a file can store.

    With `narrow`, of 8, 16 and 32 bit integers and floats only, as in NetCDF 3. The values of large arrays of
    floats are left out (`large`): they are zeros, without memory.
    """
    names = _names([*record.variables, *record.dims])
    layout: dict[str, Any] = {
        "version": VERSION,
        "names": {new: str(old) for old, new in names.items() if new != old},
        "variables": {},
    }
    empty = [str(names[d]) for d, n in record.sizes.items() if n == 0] if narrow else []
    if empty:
        layout["empty"] = empty
    variables: dict[str, Any] = {}
    for name, variable in record.variables.items():
        if not empty and large(variable):
            zero = np.zeros((), variable.dtype)
            array, description = np.broadcast_to(zero, variable.shape), _described(variable)
        else:
            array, description = _stored(str(name), np.asarray(variable.values), narrow)
        attributes = _plain(variable.attrs)
        layout["variables"][names[name]] = description | {"attributes": attributes}
        if empty:
            array = np.pad(array, [(0, int(n == 0)) for n in array.shape])
        dims = [names[d] for d in variable.dims]
        variables[names[name]] = xarray.Variable(
            dims, array, {k: v for k, v in attributes.items() if _simple(v)}
        )
    attributes = _plain(record.attrs)
    texts = {k: v for k, v in attributes.items() if isinstance(v, str)}
    layout["attributes"] = {k: None if k in texts else v for k, v in attributes.items()}
    layout["coords"] = [names[n] for n in record.coords]
    coords = {names[n]: variables.pop(names[n]) for n in record.coords}
    return xarray.Dataset(variables, coords, texts | {KEY: codec.line(layout, ascii=True)})


def large(variable: xarray.Variable) -> bool:
    """Return whether an array is read in blocks: a large one of floats, which files store as they are."""
    return variable.dtype in (np.dtype("f4"), np.dtype("f8")) and variable.nbytes > LARGE


def sources(record: xarray.Dataset, stored: xarray.Dataset) -> dict[str, xarray.Variable]:
    """Return what has the values of each stored variable: the record has those of large arrays.

    Args:
        record: the Dataset before `pack`.
        stored: what `pack` returned.
    """
    names: Mapping[str, str] = codec.parse(stored.attrs[KEY])["names"]
    originals = {str(new): record.variables[names.get(str(new), str(new))] for new in stored.variables}
    return {new: old if large(old) else stored.variables[new] for new, old in originals.items()}


def unpack(stored: xarray.Dataset, lazily: bool = False) -> xarray.Dataset:
    """Return the Dataset as it was before `pack`; a Dataset of another program is returned unchanged.

    Args:
        stored: what a file holds.
        lazily: whether values that were stored as they are stay unread: all but coordinates and arrays of
            which the file changed the type.

    Raises:
        RecordError: an array that is read differs from the one that was written.
    """
    if KEY not in stored.attrs:
        return stored
    layout = _layout(stored.attrs)
    names: Mapping[str, str] = layout["names"]
    if not lazily and set(layout["variables"]) != set(map(str, stored.variables)):
        raise DamagedFile(
            "is damaged: of its arrays,"
            f" {_listed(set(layout['variables']) ^ set(map(str, stored.variables)))} are missing or too many"
        )
    stored = stored.isel({d: slice(0, 0) for d in layout.get("empty", ())})
    variables: dict[str, Any] = {}
    for name, description in layout["variables"].items():
        variable, old = stored.variables[name].copy(deep=False), names.get(name, name)
        variable.dims = [names.get(str(d), str(d)) for d in variable.dims]
        as_stored = "labels" not in description and str(variable.dtype) == description["type"]
        if not (lazily and as_stored and name not in layout["coords"]):
            array = _restored(old, np.asarray(variable.values), description)
            variable = xarray.Variable(variable.dims, array)
        variable.attrs = description["attributes"]
        variables[old] = variable
    coords = {n: variables.pop(n) for n in [names.get(c, c) for c in layout["coords"]]}
    attributes = {
        k: stored.attrs[k] if v is None and k in stored.attrs else v for k, v in layout["attributes"].items()
    }
    record = ShownDataset(variables, coords, attributes)
    if lazily:
        record.encoding = stored.encoding
        record.set_close(stored.close)
    return record


def require_proof(attributes: Mapping[str, Any], proven: bool) -> None:
    """Refuse metadata of a later version, and those without a proof that a file of their version has.

    Raises:
        RecordError: they are of a later version.
        DamagedFile: they have no proof.
    """
    if KEY in attributes and _layout(attributes).get("version", 1) >= PROVEN and not proven:
        raise DamagedFile("is damaged: its metadata have no proof")


def whole_arrays(attributes: Mapping[str, Any]) -> set[str]:
    """Return the stored names of the arrays that have all of their chunks: they do not grow, and are not of
    an earlier version, which left out chunks of zeros.
    """
    layout = _layout(attributes)
    if layout.get("version", 1) < PROVEN:
        return set()
    return {name for name, description in layout["variables"].items() if "grows" not in description}


def _layout(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the layout that attributes list; raise RecordError if it is of a later version."""
    layout = codec.parse(str(attributes.get(KEY, "{}")))
    provenance = codec.parse(str(attributes.get(PROVENANCE, "{}")))
    file_version.require_readable("a record", layout.get("version", 1), VERSION, provenance, RecordError)
    return layout


def _stored(name: str, array: np.ndarray, narrow: bool) -> tuple[np.ndarray, dict[str, Any]]:
    description: dict[str, Any] = {"type": str(array.dtype)}
    if array.dtype.kind in "UTO" and all(isinstance(v, str) for v in array.ravel().tolist()):
        labels, codes = np.unique(array.astype(str), return_inverse=True)
        return codes.reshape(array.shape).astype(np.int32), {
            "labels": labels.tolist(),
            "sha256": _digest(codes.astype(np.int64)),
        }
    if array.dtype.kind not in "biuf":
        raise RecordError(
            f"holds values of the type {array.dtype}; a record holds numbers, true or false, and text",
            where=name,
        )
    description["sha256"] = _digest(array)
    return _narrowed(name, array) if narrow else array, description


def _narrowed(name: str, array: np.ndarray) -> np.ndarray:
    """Return numbers in a type of NetCDF 3 that holds them exactly."""
    if array.dtype in NARROW:
        return array
    if array.dtype in WIDENED:
        return array.astype(WIDENED[array.dtype])
    if array.dtype.kind == "f":
        raise RecordError(
            f"holds values of the type {array.dtype}, which NetCDF 3 does not have",
            where=name,
            fix="Save it as .zarr",
        )
    low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
    if low >= -(2**31) and high < 2**31:
        return array.astype(np.int32)
    if max(-low, high) <= EXACT_INTEGERS:
        return array.astype(np.float64)
    raise RecordError(
        "holds whole numbers beyond 2^53, which NetCDF 3 cannot hold exactly",
        where=name,
        fix="Save it as .zarr",
    )


def _restored(name: str, array: np.ndarray, description: Mapping[str, Any]) -> np.ndarray:
    if "labels" in description:
        codes = array.astype(np.int64)
        labels = np.asarray(description["labels"], dtype=str)
        good = _digest(codes) == description["sha256"] and (
            not codes.size or 0 <= codes.min() <= codes.max() < len(labels)
        )
        out = labels[codes] if good else codes
    else:
        out = array.astype(np.dtype(description["type"]))
        good = (
            "sha256" not in description or _digest(out) == description["sha256"]
        )  # of growing arrays each chunk has its own
    if not good:
        raise DamagedFile(
            f"is damaged: the values of {name!r} are not those that were written",
            fix="Run it again, or take another copy",
        )
    return out


def _digest(array: np.ndarray) -> str:
    little = np.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"), copy=False))
    return hashlib.sha256(str(array.shape).encode() + little.tobytes()).hexdigest()


def _described(variable: xarray.Variable) -> dict[str, Any]:
    """Return type and hash of an array that is read in blocks; the hash is that of `_digest`."""
    little, digest = variable.dtype.newbyteorder("<"), hashlib.sha256(str(variable.shape).encode())
    for slab in slabs(variable.shape, BLOCK):
        digest.update(np.ascontiguousarray(variable[slab].values).astype(little, copy=False).tobytes())
    return {"type": str(variable.dtype), "sha256": digest.hexdigest()}


def _names(names: list[Hashable]) -> dict[Hashable, str]:
    """Return a plain name for each name; no two differ in case only, since some disks ignore case."""
    out: dict[Hashable, str] = {}
    taken: set[str] = set()
    for name in dict.fromkeys(names):
        text = unicodedata.normalize("NFKD", str(name)).encode("ascii", "ignore").decode()
        text = re.sub(r"[^A-Za-z0-9_.]+", "_", text)[:LONGEST].strip(".")
        if not text or not text[0].isalpha() or text in RESERVED:
            text = f"v_{text}".rstrip("_")
        base, n = text, 1
        while text.casefold() in taken:
            n += 1
            text = f"{base}_{n}"
        taken.add(text.casefold())
        out[name] = text
    return out


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    return {str(k): _json(v) for k, v in attributes.items() if k not in OF_FILES}


def _json(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    try:
        return codec.parse(codec.line(value))
    except (TypeError, ValueError):
        return str(value)


def _simple(value: Any) -> bool:
    """Return whether every format can store the value as an attribute."""
    if isinstance(value, bool):
        return False
    return (
        (isinstance(value, str) and value != "")
        or isinstance(value, float)
        or (isinstance(value, int) and abs(value) < 2**31)
    )


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))
