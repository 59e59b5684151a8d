"""The document as JSON, with its arrays in one hashed file beside it.

Reading trusts nothing: sizes and nesting are bounded, numbers must be finite, arrays are plain numbers from a file of
the document's own folder whose hash is written in the document, and user functions stay inert until they are trusted.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np

from deodar.element import Element
from deodar.errors import AxesError, DeodarError, DocumentError, ParameterError, Problem, UnknownName, did_you_mean
from deodar.model import edit, find, output
from deodar.model.document import READS, VERSION, Connection, Document, Entry, Knob
from deodar.model.paths import Names, display, split, stored_id
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, leaves, part_from_json, to_json

MOST_BYTES = 64 * 2**20
DEEPEST = 64
KEYS = ("deodar", "name", "time_unit", "dt", "t0", "axes", "parameters", "elements", "connections", "groups", "arrays", "notes", "layout")


# ------------------------------------------------------------------------------------------------ out


def to_data(doc: Document) -> tuple[dict[str, Any], dict[str, FrozenArray]]:
    """The document as plain data in a stable order of keys, and its arrays by key."""
    axes: dict[str, Axis] = {}
    arrays: dict[str, FrozenArray] = {}

    def axis_key(axis: Axis) -> str:
        return _key(axes, axis.name, axis)

    def array_key(array: FrozenArray) -> str:
        return _key(arrays, "array", array)

    by = doc.by_id()
    elements: dict[str, Any] = {}
    for e in doc.entries:
        body = to_json(e.element, axis_key, array_key)
        elements[e.path] = {"kind": body.pop("kind"), "id": e.id, **({"every": e.every} if e.every != 1 else {}), **body}
    connections = [
        {"source": f"{by[c.source].path}.{c.source_port}", "target": f"{by[c.target].path}.{c.target_port}"} | ({"reads": c.reads} if c.reads else {})
        for c in doc.connections
    ]
    knobs = {k.name: {"value": k.value, "links": [f"{by[i].path}.{leaf}" for i, leaf in k.links]} for k in doc.knobs}
    data: dict[str, Any] = {"deodar": VERSION, "name": doc.name, "time_unit": doc.time_unit}
    data |= {} if doc.dt is None else {"dt": doc.dt}
    data |= {} if doc.t0 == 0 else {"t0": doc.t0}
    data["axes"] = {key: _axis_data(axis) for key, axis in axes.items()}
    data |= {"parameters": knobs, "elements": elements, "connections": connections, "groups": [display(g) for g in doc.groups]}
    data |= {"notes": doc.notes} if doc.notes else {}
    data |= {"layout": dict(doc.layout)} if doc.layout else {}
    return data, arrays


def dumps(doc: Document, arrays_file: str = "") -> tuple[str, bytes | None]:
    """The document as JSON text, and the content of its array file (None without arrays)."""
    data, arrays = to_data(doc)
    packed = pack(arrays) if arrays else None
    if packed is not None:
        digest = hashlib.sha256(packed).hexdigest()
        entry = {"file": f"{arrays_file}.{digest[:8]}.npz" if arrays_file else "", "sha256": digest}
        data = {key: value for key, value in (data | {"arrays": entry}).items()}
    ordered = {key: data[key] for key in KEYS if key in data}
    return json.dumps(ordered, indent=2, ensure_ascii=False) + "\n", packed


def pack(arrays: Mapping[str, FrozenArray]) -> bytes:
    """The content of an array file; the same arrays always give the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as z:
        for key, array in arrays.items():
            one = io.BytesIO()
            np.lib.format.write_array(one, array.data, allow_pickle=False)
            z.writestr(zipfile.ZipInfo(f"{key}.npy", (1980, 1, 1, 0, 0, 0)), one.getvalue(), zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def save(doc: Document, path: str | Path, force: bool = False) -> None:
    """Write the document, its array file first; refuses to replace a file unless `force`."""
    path = Path(path)
    output.claim(path, force)
    text, packed = dumps(doc, path.stem)
    old = _old_arrays(path) if force else None
    new = None
    if packed is not None:
        new = path.with_name(json.loads(text)["arrays"]["file"])
        if not (new.is_file() and hashlib.sha256(new.read_bytes()).hexdigest() == json.loads(text)["arrays"]["sha256"]):
            output.write(output.claim(new, force), packed)
    output.write(path, text.encode())
    if old is not None and old != new:
        old.unlink(missing_ok=True)


def _old_arrays(path: Path) -> Path | None:
    """The array file of the document that stands at `path`, if it is one of ours."""
    try:
        name = json.loads(path.read_text())["arrays"]["file"]
        old = path.with_name(name)
        return old if Path(name).name == name and name.startswith(path.stem + ".") and old.is_file() else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _key(table: dict[str, Any], wish: str, value: Any) -> str:
    for key, known in table.items():
        if known == value:
            return key
    key, n = wish, 1
    while key in table:
        n += 1
        key = f"{wish}_{n}"
    table[key] = value
    return key


def _axis_data(axis: Axis) -> dict[str, Any]:
    out: dict[str, Any] = {"name": axis.name, "lower": axis.lower, "upper": axis.upper, "samples": axis.samples}
    return out | ({"periodic": True} if axis.periodic else {}) | ({"unit": axis.unit} if axis.unit else {})


# ------------------------------------------------------------------------------------------------ in


def load(path: str | Path) -> Document:
    """Read a document; every problem is listed at once, nothing is half-loaded."""
    path = Path(path)
    if not path.exists():
        near = did_you_mean(path.name, [p.name for p in path.parent.glob("*.json")]) if path.parent.is_dir() else ""
        raise DocumentError("there is no such file", where=str(path), fix=near)
    if not path.is_file():
        raise DocumentError("is not a file", where=str(path))
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise DocumentError(f"is {size / 2**20:.0f} MiB; a document has at most {MOST_BYTES // 2**20}", where=str(path))
    try:
        data = parse(path.read_bytes())
        arrays = _arrays(data, path.parent) if isinstance(data, dict) else {}
        return from_data(data, arrays)
    except DeodarError as error:
        problems = [Problem(f"{path.name}: {p.where}" if p.where else path.name, p.what, p.fix) for p in error.problems]
        raise DocumentError(problems) from None
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", where=str(path)) from None


def parse(text: bytes | str) -> Any:
    """JSON with finite numbers, unique keys and bounded nesting."""

    def refuse(constant: str) -> Any:
        raise DocumentError(f"holds the number {constant}, which is not finite")

    def number(text: str) -> float:
        value = float(text)
        if not math.isfinite(value):
            raise DocumentError(f"holds the number {text[:40]}, which is not finite")
        return value

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        out = dict(pairs)
        if len(out) < len(pairs):
            names = [k for k, _ in pairs]
            raise DocumentError(f"the key {next(k for k in names if names.count(k) > 1)!r} occurs twice")
        return out

    try:
        data = json.loads(text, parse_constant=refuse, parse_float=number, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise DocumentError(f"is not JSON: {error.msg} in line {error.lineno}, column {error.colno}") from None
    except UnicodeDecodeError:
        raise DocumentError("is not JSON: it is not text in UTF-8") from None
    except RecursionError:
        raise DocumentError(f"is nested deeper than {DEEPEST} levels") from None
    except ValueError as error:  # a whole number of thousands of digits
        raise DocumentError(f"is not JSON: {error}") from None
    _depth(data)
    return data


def _depth(data: Any) -> None:
    level, below = 0, [data]
    while below:
        level += 1
        if level > DEEPEST:
            raise DocumentError(f"is nested deeper than {DEEPEST} levels")
        below = [v for item in below for v in _inside(item) if isinstance(v, (dict, list))]


def _inside(item: Any) -> list[Any]:
    if isinstance(item, dict):
        return list(cast("dict[str, Any]", item).values())
    return cast("list[Any]", item) if isinstance(item, list) else []


def _arrays(data: dict[str, Any], folder: Path) -> dict[str, FrozenArray]:
    entry = data.get("arrays")
    if entry is None:
        return {}
    if not isinstance(entry, dict) or not isinstance(cast(Any, entry).get("file"), str) or not isinstance(cast(Any, entry).get("sha256"), str):
        raise DocumentError("needs a file and its sha256", where="arrays")
    name, digest = cast("dict[str, str]", entry)["file"], cast("dict[str, str]", entry)["sha256"]
    path = folder / name
    if Path(name).name != name or name in ("", ".", "..") or "\\" in name or path.is_symlink():
        raise DocumentError(f"the array file {name!r} lies outside the document's folder", where="arrays")
    if not path.is_file():
        raise DocumentError(f"the array file {name!r} is missing; it belongs beside the document", where="arrays")
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != digest:
        raise DocumentError(f"the array file {name!r} is not the one this document was saved with: its hash differs", where="arrays")
    return unpack(content, name)


def unpack(content: bytes, name: str) -> dict[str, FrozenArray]:
    """The arrays of an array file; objects that would need pickle are refused."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as z:
            out: dict[str, FrozenArray] = {}
            for key in z.files:
                array = z[key]
                if array.dtype.kind not in "fiub" or not np.isfinite(array).all():
                    raise DocumentError(f"the array {key!r} in {name!r} does not hold finite numbers only", where="arrays")
                out[key] = FrozenArray(array)
            return out
    except DocumentError:
        raise
    except Exception as error:
        raise DocumentError(f"the array file {name!r} cannot be read as plain arrays ({type(error).__name__}: {error})", where="arrays") from None


def from_data(data: Any, arrays: Mapping[str, FrozenArray]) -> Document:
    """The document that plain data describe; raises with every problem found."""
    return _Reader(data, arrays).read()


class _Reader:
    def __init__(self, data: Any, arrays: Mapping[str, FrozenArray]) -> None:
        if not isinstance(data, dict):
            raise DocumentError(f"is not a deodar document: it holds {type(data).__name__}, not an object")
        self.data = cast("dict[str, Any]", data)
        self.arrays = arrays
        self.problems: list[Problem] = []

    def read(self) -> Document:
        version = self.data.get("deodar")
        if version is None:
            raise DocumentError(
                "is not a deodar document: it has no key 'deodar'", fix="Files of other programs are opened with: deodar import FILE -o OUT"
            )
        if version != VERSION or isinstance(version, bool):
            raise DocumentError(
                f"is a document of version {version!r}; this deodar reads version {VERSION}", fix="Type: pip install --upgrade deodar"
            )
        for key in self.data:
            if key not in KEYS:
                self.problem(key, "is no key of a document", did_you_mean(key, KEYS))
        doc = self.general(Document(self.text("name", "model")))
        axes = self.axes()
        doc = self.elements(doc, axes)
        doc = self.groups(doc)
        if not self.problems:  # connections and links of elements that could not be read would only repeat their problems
            doc = self.knobs(self.connections(doc))
        if self.problems:
            raise DocumentError(self.problems)
        return doc

    def problem(self, where: str, what: str, fix: str = "") -> None:
        self.problems.append(Problem(where, what, fix))

    def attempt(self, where: str, doc: Document, change: Any) -> Document:
        try:
            return change(doc)
        except DeodarError as error:
            self.problems += [Problem(where if p.where in ("", where) else f"{where}: {p.where}", p.what, p.fix) for p in error.problems]
            return doc

    def text(self, key: str, default: str) -> str:
        value = self.data.get(key, default)
        if not isinstance(value, str):
            self.problem(key, f"needs text, not {value!r}")
            return default
        return value

    def table(self, key: str) -> dict[str, Any]:
        value = self.data.get(key, {})
        if not isinstance(value, dict):
            self.problem(key, f"needs an object, not {type(value).__name__}")
            return {}
        return cast("dict[str, Any]", value)

    def rows(self, key: str) -> list[Any]:
        value = self.data.get(key, [])
        if not isinstance(value, list):
            self.problem(key, f"needs a list, not {type(value).__name__}")
            return []
        return cast("list[Any]", value)

    def general(self, doc: Document) -> Document:
        doc = self.attempt("time_unit", doc, lambda d: edit.describe(d, time_unit=self.data.get("time_unit", "ms")))
        doc = self.attempt("dt", doc, lambda d: edit.describe(d, dt=self.data.get("dt")))
        t0 = self.data.get("t0", 0.0)
        if isinstance(t0, bool) or not isinstance(t0, (int, float)):
            self.problem("t0", f"needs a number, not {t0!r}")
            t0 = 0.0
        return edit.describe(doc, t0=t0, notes=self.text("notes", ""), layout=self.table("layout"))

    def axes(self) -> dict[str, Axis]:
        out: dict[str, Axis] = {}
        known = ("name", "lower", "upper", "samples", "periodic", "unit")
        for key, value in self.table("axes").items():
            if not isinstance(value, dict):
                self.problem(f"axes.{key}", f"needs an object, not {value!r}")
                continue
            values = cast("dict[str, Any]", value)
            strange = [k for k in values if k not in known]
            missing = [k for k in ("lower", "upper", "samples") if k not in values]
            if strange or missing:
                what = f"has no {missing[0]}" if missing else f"{strange[0]!r} is no property of an axis"
                self.problem(f"axes.{key}", what, did_you_mean(strange[0], known) if strange else "")
                continue
            try:
                out[key] = Axis(**({"name": key} | values))
            except AxesError as error:
                self.problems += [Problem(f"axes.{key}", p.what, p.fix) for p in error.problems]
        return out

    def elements(self, doc: Document, axes: Mapping[str, Axis]) -> Document:
        entries: list[Entry] = []
        ids: set[str] = set()
        for path, value in self.table("elements").items():
            where = f"elements.{path}"
            if not isinstance(value, dict):
                self.problem(where, f"needs an object, not {value!r}")
                continue
            body = dict(cast("dict[str, Any]", value))
            ident, every = body.pop("id", None), body.pop("every", 1)
            if "name" in body:
                self.problem(f"{where}.name", "a name is the last part of the path, not a parameter")
                continue
            try:
                names = split(path)
                part = part_from_json(body, path, axes, self.arrays, Element, names[-1])
            except (ParameterError, UnknownName) as error:
                self.problems += error.problems
                continue
            if ident is None:
                ident = stored_id(path, ids)
            if not isinstance(ident, str) or len(ident) != 8 or any(c not in "0123456789abcdef" for c in ident):
                self.problem(f"{where}.id", f"is {ident!r}; it is eight hexadecimal digits")
                continue
            if ident in ids:
                self.problem(f"{where}.id", f"{ident} belongs to another element too")
                continue
            if isinstance(every, bool) or not isinstance(every, int) or every < 1:
                self.problem(f"{where}.every", f"is {every!r}; it is a whole number of ticks, at least 1")
                continue
            ids.add(ident)
            entries.append(Entry(ident, names, part, every))
        paths = {e.names for e in entries}
        for e in entries:
            if any(e.names[:k] in paths for k in range(1, len(e.names))) or any(not n for n in e.names):
                self.problem(f"elements.{e.path}", "cannot stand inside an element as in a group")
        return edit.dc.replace(doc, entries=tuple(entries), groups=_groups(e.group for e in entries))

    def groups(self, doc: Document) -> Document:
        for g in self.rows("groups"):
            if not isinstance(g, str) or not g:
                self.problem("groups", f"needs paths, not {g!r}")
                continue
            doc = edit.group(doc, split(g))
        return doc

    def connections(self, doc: Document) -> Document:
        for k, row in enumerate(self.rows("connections")):
            where = f"connections.{k}"
            if not isinstance(row, dict) or not all(isinstance(cast(Any, row).get(key), str) for key in ("source", "target")):
                self.problem(where, "needs a source and a target")
                continue
            value = cast("dict[str, str]", row)
            strange = [key for key in value if key not in ("source", "target", "reads")]
            if strange:
                self.problem(where, f"{strange[0]!r} is no property of a connection")
                continue
            doc = self.attempt(where, doc, lambda d, v=value: _connected(d, v))
        return doc

    def knobs(self, doc: Document) -> Document:
        for name, value in self.table("parameters").items():
            where = f"parameters.{name}"
            body = cast("dict[str, Any]", value) if isinstance(value, dict) else {"value": value}
            number, links = body.get("value"), body.get("links", [])
            if isinstance(number, bool) or not isinstance(number, (int, float)) or not isinstance(links, list):
                self.problem(where, "needs a value (a number) and links (a list of paths)")
                continue
            doc = self.attempt(where, doc, lambda d, n=name, v=number: edit.knob(d, n, v))
            for path in cast("list[Any]", links):
                doc = self.attempt(where, doc, lambda d, n=name, p=path: _linked(d, str(p), n))
        return doc


def _connected(doc: Document, row: Mapping[str, str]) -> Document:
    source, source_port = find.port(doc, row["source"])
    target, target_port = find.port(doc, row["target"], "")
    reads = row.get("reads", "")
    if reads not in READS:
        raise DocumentError(f"reads is {reads!r}; it is one of previous, current, delayed")
    return edit.connect(doc, source, source_port, target, target_port, reads)


def _linked(doc: Document, path: str, name: str) -> Document:
    found = find.target(doc, path)
    if found.entry is None:
        raise UnknownName(f"{path!r} names no parameter of an element")
    if found.parameter not in [leaf for leaf, _, _ in leaves(found.entry.element)]:
        raise UnknownName(f"{path!r} is not a number that can change while the model runs")
    return edit.link(doc, found.entry.id, found.parameter, name)


def _groups(groups: Any) -> tuple[Names, ...]:
    out: list[Names] = []
    for g in groups:
        out += [g[:k] for k in range(1, len(g) + 1) if g[:k] not in out]
    return tuple(out)


__all__ = ["Connection", "Knob", "dumps", "from_data", "load", "pack", "parse", "save", "to_data", "unpack"]
