"""The document as JSON with its arrays in one hashed file beside it, or both in one file, `NAME.deodar`.

Reading trusts no content: sizes and nesting are bounded, numbers must be finite, arrays are plain numbers
from a file in the document's own folder whose hash the document states, and user functions are not imported
until the user trusts the document.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import re
import time
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np
import psutil

from deodar import codec, file_version, npz, part_data, registry, regular_file
from deodar.errors import DocumentError, did_you_mean, reading
from deodar.leaves import parameter_values
from deodar.model import output, package
from deodar.model.document import KEYS, VERSION, Document
from deodar.model.parts import kinds_in, to_json
from deodar.model.paths import display
from deodar.model.reader import from_data, require_document
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, show

MOST_BYTES = 64 * 2**20
"""Largest size of a document file; larger data are stored as arrays (a guess, hundreds of times the largest
known architecture).
"""

ARRAY_ENDING = r"\.[0-9a-f]{8}\.npz"
"""Pattern of the names of array files behind that of their document: the beginning of their SHA-256."""

ENDING_LENGTH = len("12345678.npz")

LEFT_SECONDS = 600
"""Age of an array file without a document from which on it is one that was left behind, in seconds: saving
takes much less (a guess).
"""

ARRAY_SHARE = 0.5
"""Share of the free memory that the arrays of a document may take (a guess that leaves memory for a run)."""


# -------------------------------------------------------------------------------------------------------- out


def to_data(doc: Document) -> tuple[dict[str, Any], dict[str, FrozenArray]]:
    """Return the document as plain data with keys in a stable order, and its arrays by key."""
    axis_keys = _axis_keys(doc)
    arrays: dict[str, FrozenArray] = {}

    def array_key(array: FrozenArray) -> str:
        return _key(arrays, "array", array)

    by = doc.by_id()
    elements: dict[str, Any] = {}
    for e in doc.entries:
        body = to_json(e.element, axis_keys.__getitem__, array_key)
        elements[e.path] = {
            "kind": body.pop("kind"),
            "id": e.id,
            **({"every": e.every} if e.every != 1 else {}),
            **body,
        }
    connections = [
        {"source": f"{by[c.source].path}.{c.source_port}", "target": f"{by[c.target].path}.{c.target_port}"}
        | ({"reads": c.reads} if c.reads else {})
        for c in doc.connections
    ]
    shared = {
        k.name: {"value": k.value, "links": [f"{by[i].path}.{leaf}" for i, leaf in k.links]}
        for k in doc.parameters
    }
    data: dict[str, Any] = {"deodar": VERSION, "name": doc.name, "time_unit": doc.time_unit}
    data |= {} if doc.dt is None else {"dt": doc.dt}
    data |= {} if doc.t0 == 0 else {"t0": doc.t0}
    data["axes"] = {key: part_data.to_data(axis, kind=False, without=()) for axis, key in axis_keys.items()}
    data |= {
        "parameters": shared,
        "elements": elements,
        "connections": connections,
        "groups": [display(g) for g in doc.groups],
    }
    uses = {
        display(u.group): {"template": u.template, "elements": {t: by[i].path for t, i in u.elements}}
        for u in doc.uses
    }
    data |= {"uses": uses} if uses else {}
    packages = {kind: registry.package(kind) for kind in sorted(set(kinds_in(elements)))}
    data |= {"packages": {kind: p for kind, p in packages.items() if p}} if any(packages.values()) else {}
    data |= {"notes": doc.notes} if doc.notes else {}
    data |= {"layout": dict(doc.layout)} if doc.layout else {}
    return data, arrays


def axes(doc: Document) -> dict[str, Axis]:
    """Return the axes of a document by their keys, as `to_data` does."""
    return {key: axis for axis, key in _axis_keys(doc).items()}


def _axis_keys(doc: Document) -> dict[Axis, str]:
    """Return the keys of the axes of a document: their names, numbered where several axes have one name."""
    keys: dict[Axis, str] = {}
    taken: set[str] = set()
    numbers: dict[str, int] = {}
    for axis in [*(axis for e in doc.entries for axis in e.axes), *doc.spare_axes]:
        if axis in keys:
            continue
        key, number = axis.name, numbers.get(axis.name, 1)
        while key in taken:
            number += 1
            key = f"{axis.name}_{number}"
        keys[axis], numbers[axis.name] = key, number
        taken.add(key)
    return keys


def arrays(doc: Document) -> dict[str, FrozenArray]:
    """Return the arrays of a document by their keys, as `to_data` does."""
    table: dict[str, FrozenArray] = {}
    for e in doc.entries:
        for p, value in parameter_values(e.element):
            if p.form == "array":
                _key(table, "array", value)
    return table


def axis_key(table: dict[str, Axis], axis: Axis) -> str:
    """Return the key of an axis in a table of axes; a new axis is added to it."""
    return _key(table, axis.name, axis)


def dumps(doc: Document, arrays_file: str = "") -> tuple[str, bytes | None]:
    """Return the document as JSON text, and the content of its array file (None without arrays)."""
    body, arrays = to_data(doc)
    body[file_version.KEY] = file_version.HERE
    packed = pack(arrays) if arrays else None
    if packed is not None:
        digest = hashlib.sha256(packed).hexdigest()
        entry = {"file": f"{arrays_file}.{digest[:8]}.npz" if arrays_file else "", "sha256": digest}
        body = {key: value for key, value in (body | {"arrays": entry}).items()}
    ordered = {key: body[key] for key in KEYS if key in body}
    return codec.text(ordered, finite=True) + "\n", packed


def pack(arrays: Mapping[str, FrozenArray]) -> bytes:
    """Return the content of an array file; equal arrays always give equal bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as z:
        for key, array in arrays.items():
            npy = io.BytesIO()
            np.lib.format.write_array(npy, array.data, allow_pickle=False)
            z.writestr(
                zipfile.ZipInfo(f"{key}.npy", (1980, 1, 1, 0, 0, 0)), npy.getvalue(), zipfile.ZIP_DEFLATED
            )
    return buffer.getvalue()


def save(doc: Document, path: str | Path, force: bool = False) -> None:
    """Write the document, its array file first; `force` replaces an existing file of another script.

    A file whose name ends in .deodar contains both.
    """
    path = output.claim(path, force)
    text, packed = dumps(doc, path.stem)
    if path.suffix.lower() == package.SUFFIX:
        beside = {array_file(text): packed} if packed is not None else {}
        output.write(path, package.pack({f"{path.stem}.json": text.encode(), **beside}))
        return
    old, new = own_array_file(regular_file.read_bytes(path) if path.is_file() else b"", path.stem), ""
    with contextlib.ExitStack() as undo:
        if packed is not None:
            new = array_file(text)
            place = path.with_name(new)
            if not (place.is_file() and regular_file.read_bytes(place) == packed):
                output.write(output.claim(place, force), packed)
                undo.callback(place.unlink, missing_ok=True)
        output.write(path, text.encode())
        undo.pop_all()
    leftovers = left_arrays(path.parent, path.stem, new)
    for place in [*leftovers, path.with_name(old)] if old and old != new else leftovers:
        place.unlink(missing_ok=True)


def left_arrays(folder: Path, stem: str = "", named: str = "") -> list[Path]:
    """Return array files, with names that `save` gives, that no document of their folder names.

    A process that was killed leaves one: arrays are written before the document that names them. So one that
    is younger than LEFT_SECONDS is not returned: its document may follow.

    Args:
        folder: the folder.
        stem: name of the document without the ending; "": any.
        named: an array file that a document names.
    """
    form = re.compile((re.escape(stem) or ".+") + ARRAY_ENDING)
    try:
        arrays = [path for path in folder.iterdir() if form.fullmatch(path.name) and path.name != named]
        arrays = [path for path in arrays if time.time() - path.lstat().st_mtime > LEFT_SECONDS]
        arrays = [path for path in arrays if _is_array_file(path)]
        texts = [regular_file.read_bytes(path) for path in folder.iterdir() if arrays and _may_name(path)]
    except OSError:
        return []
    return [path for path in arrays if not any(path.name[-ENDING_LENGTH:].encode() in text for text in texts)]


def _is_array_file(path: Path) -> bool:
    """Return whether the name of a file is that of its content, so that `save` wrote it."""
    digest = hashlib.sha256(regular_file.read_bytes(path)).hexdigest()
    return path.name[-ENDING_LENGTH:].startswith(digest[:8])


def _may_name(path: Path) -> bool:
    """Return whether a file may be a document, also one that was renamed to keep it."""
    return path.is_file() and path.suffix != ".npz" and path.stat().st_size <= MOST_BYTES


def array_file(content: bytes | str) -> str:
    """Return the name of the file with the arrays of a document, given as text; "": there is none."""
    try:
        name = codec.parse(content)["arrays"]["file"]
        return name if Path(name).name == name else ""
    except (ValueError, KeyError, TypeError):
        return ""


def own_array_file(content: bytes, stem: str) -> str:
    """Return the array file of a document if its name is one that `save` gives, so that it is the document's
    alone; "": there is none.

    Args:
        content: the document as text.
        stem: name of its file without the ending.
    """
    name = array_file(content)
    return name if re.fullmatch(re.escape(stem) + ARRAY_ENDING, name) else ""


def _key(table: dict[str, Any], base: str, shared: Any) -> str:
    for key, present in table.items():
        if present == shared:
            return key
    key, n = base, 1
    while key in table:
        n += 1
        key = f"{base}_{n}"
    table[key] = shared
    return key


# --------------------------------------------------------------------------------------------------------- in


def load(path: str | Path) -> Document:
    """Read a document; the error lists every problem, and no partial document is returned."""
    if not isinstance(path, (str, Path)):
        raise DocumentError(f"needs the path of a file, not {show(path)}")
    path = Path(path)
    with reading(path, DocumentError):
        require_file(path)
        if package.is_package(path):
            return _load_package(path)
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise DocumentError(f"is {size / 2**20:.0f} MiB; a document has at most {MOST_BYTES // 2**20}")
        data = codec.read(regular_file.read_bytes(path))
        return from_data(data, _arrays(data, lambda name: _beside(path.parent / name)))


def require_file(path: Path) -> None:
    """Refuse a path without a file; the error suggests a document of the same folder with a similar name."""
    if not path.exists():
        documents = [p.name for p in path.parent.glob("*.json")] if path.parent.is_dir() else []
        raise DocumentError("there is no such file", fix=did_you_mean(path.name, documents))
    if not path.is_file():
        raise DocumentError("is not a file")


def loads(content: bytes, beside: Callable[[str], bytes | None]) -> Document:
    """Read a document, or a package, from the content of its file.

    Args:
        content: the content of the file.
        beside: returns the content of the array file that a document names, or None if it does not exist. A
            package contains its own array file.

    Raises:
        DocumentError: the document has problems; the error lists all.
    """
    if package.is_content(content):
        return _load_package(io.BytesIO(content))
    return of_data(codec.read(content), beside)


def of_data(data: Any, beside: Callable[[str], bytes | None]) -> Document:
    """Return the document of plain data; `beside` as in `loads`."""
    return from_data(data, _arrays(data, beside))


def _load_package(file: Path | BinaryIO) -> Document:
    with package.Package(file) as packed:
        data = codec.read(packed.document(MOST_BYTES))
        arrays = _arrays(data, lambda name: packed.read(name, require_room))
        packed.require_only(data["arrays"]["file"] if arrays else "")
        return from_data(data, arrays)


def _beside(path: Path) -> bytes | None:
    """Return the content of an array file beside a document; None if it does not exist."""
    if path.is_symlink():
        raise DocumentError(
            f"the array file {path.name!r} lies outside the document's folder", where="arrays"
        )
    if not path.is_file():
        return None
    require_room(path.stat().st_size, path.name)
    return regular_file.read_bytes(path)


def require_room(size: int, name: str) -> None:
    """Refuse arrays that do not fit into memory, before they are unpacked."""
    free = psutil.virtual_memory().available
    if size > ARRAY_SHARE * free:
        problem = f"the arrays in {name!r} take {size / 2**30:,.1f} GiB; {free / 2**30:,.1f} GiB are free"
        raise DocumentError(problem, where="arrays")


def _arrays(data: Any, read: Callable[[str], bytes | None]) -> dict[str, FrozenArray]:
    """Return the arrays that a document names; `read` returns the content of a file of its folder, or
    None.
    """
    require_document(data)
    entry = data.get("arrays")
    if entry is None:
        return {}
    if (
        not isinstance(entry, dict)
        or set(cast(Any, entry)) != {"file", "sha256"}
        or not all(isinstance(v, str) for v in cast(Any, entry).values())
    ):
        raise DocumentError("needs a file and its sha256", where="arrays")
    name, digest = cast("dict[str, str]", entry)["file"], cast("dict[str, str]", entry)["sha256"]
    if Path(name).name != name or name in ("", ".", "..") or "\\" in name:
        raise DocumentError(f"the array file {name!r} lies outside the document's folder", where="arrays")
    content = read(name)
    if content is None:
        raise DocumentError(
            f"the array file {show(name)} is missing; it belongs beside the document", where="arrays"
        )
    if hashlib.sha256(content).hexdigest() != digest:
        raise DocumentError(
            f"the array file {name!r} is not the one this document was saved with: its hash differs",
            where="arrays",
        )
    return unpack(content, name)


def unpack(content: bytes, name: str) -> dict[str, FrozenArray]:
    """Return the arrays of an array file; objects that need pickle are refused."""
    out: dict[str, FrozenArray] = {}
    try:
        for key, array in npz.arrays(content, ARRAY_SHARE * psutil.virtual_memory().available):
            if array.dtype.kind not in "fiub" or not np.isfinite(array).all():
                raise DocumentError(
                    f"the array {key!r} in {name!r} does not hold finite numbers only", where="arrays"
                )
            out[key] = FrozenArray(array)
    except (MemoryError, ValueError) as error:
        raise DocumentError(
            f"the array file {name!r} cannot be read as plain arrays ({error})", where="arrays"
        ) from None
    return out


__all__ = [
    "array_file",
    "arrays",
    "axes",
    "axis_key",
    "dumps",
    "from_data",
    "load",
    "loads",
    "of_data",
    "own_array_file",
    "pack",
    "require_file",
    "require_room",
    "save",
    "to_data",
    "unpack",
]
