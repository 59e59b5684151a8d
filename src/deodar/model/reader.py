"""Convert plain data to a document: every problem is listed, and no partial document is returned."""

from __future__ import annotations

import dataclasses as dc
import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from typing import Any, cast

from deodar import file_version, plugins, registry
from deodar.element import Element
from deodar.errors import (
    AxesError,
    DeodarError,
    DocumentError,
    Fix,
    ParameterError,
    Problem,
    UnknownName,
    did_you_mean,
)
from deodar.leaves import leaves
from deodar.model import edit, find
from deodar.model.document import KEYS, READS, VERSION, Document, Entry
from deodar.model.migrations import migrate
from deodar.model.parts import part_from_json
from deodar.model.paths import PathNames, display, split, stored_id
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, show

IDENT = re.compile("[0-9a-f]{8}")

MOST_PROBLEMS = 100
"""Largest number of connections whose problems are listed: each is compared with all names, which takes long
if both are many.
"""

MOST_LISTED = 1000
"""Largest number of problems of a document that are listed: each takes a kilobyte."""

MOST_ENTRIES: Mapping[str, int] = {
    "elements": 100_000,
    "connections": 400_000,
    "axes": 100_000,
    "groups": 5000,
    "parameters": 5000,
    "uses": 5000,
    "packages": 1000,
}
"""Largest numbers of entries by the keys of a document (guesses, a hundred times the largest known ones)."""


def from_data(data: Any, arrays: Mapping[str, FrozenArray]) -> Document:
    """Return the document that plain data describe; the error lists every problem."""
    require_document(data)
    with file_version.naming_later_writer(data):
        return _Reader(data, arrays).read()


def require_document(data: Any) -> None:
    """Refuse plain data that are no document, one of a later version, or one of too many entries.

    Raises:
        DocumentError: they are not.
    """
    if not isinstance(data, dict):
        raise DocumentError(f"is not a deodar document: it holds {type(data).__name__}, not an object")
    content = cast("dict[str, Any]", data)
    if "deodar" not in content:
        if "experiment" in content:
            fix = Fix("Open it: dd.Experiment.load(FILE)", "Type: deodar experiment FILE --check")
            raise DocumentError("is not a model: it is an experiment", fix=fix)
        raise DocumentError("is not a deodar document: it has no key 'deodar'")
    file_version.require_readable("a document", content["deodar"], VERSION, content)
    for key, most in MOST_ENTRIES.items():
        entries = content.get(key)
        if isinstance(entries, (dict, list)) and len(cast("list[Any]", entries)) > most:
            raise DocumentError(f"holds {len(entries):,} {key}; at most {most:,} are read")


class _Reader:
    def __init__(self, data: dict[str, Any], arrays: Mapping[str, FrozenArray]) -> None:
        self.data = migrate(data)
        self.arrays = arrays
        self.problems: list[Problem] = []

    def read(self) -> Document:
        for key in self.data:
            if key not in KEYS:
                self.problem(key, "is not a key of a document", did_you_mean(key, KEYS))
        if "elements" not in self.data:
            self.problem("elements", "is missing", 'A document without elements holds "elements": {}')
        doc = self.general(Document(self.text("name", "model"), foreign=True))
        axes = self.axes()
        doc = self.groups(self.elements(doc, axes))
        # connections and links of elements that failed would only repeat their problems
        if not self.problems:
            doc = self.uses(self.parameters(self.connections(doc)))
        needed = plugins.stated(self.data.get("packages", {}), self.problems)
        if self.problems:
            packages = [p.name for p in registry.packaged()]
            raise DocumentError([*plugins.unfit(needed, _package, packages), *self.problems])
        return dc.replace(doc, spare_axes=tuple(axes.values()))

    def problem(self, where: str, fault: str, fix: str = "") -> None:
        self.add([Problem(where, fault, fix)])

    def add(self, problems: Iterable[Problem]) -> None:
        """Add problems to the list.

        Raises:
            DocumentError: it is longer than anybody reads.
        """
        self.problems += problems
        if len(self.problems) > MOST_LISTED:
            last = Problem("", f"has more than {MOST_LISTED:,} problems; the rest of it was not read")
            raise DocumentError([*self.problems[:MOST_LISTED], last])

    def attempt(self, where: str, doc: Document, change: Any) -> Document:
        try:
            return change(doc)
        except DeodarError as error:
            self.add(
                Problem(where if p.where in ("", where) else f"{where}: {p.where}", p.what, p.fix)
                for p in error.problems
            )
            return doc

    def text(self, key: str, default: str) -> str:
        text = self.data.get(key, default)
        if not isinstance(text, str):
            self.problem(key, f"needs text, not {show(text)}")
            return default
        return text

    def table(self, key: str) -> dict[str, Any]:
        table = self.data.get(key, {})
        if not isinstance(table, dict):
            self.problem(key, f"needs an object, not {type(table).__name__}")
            return {}
        return cast("dict[str, Any]", table)

    def rows(self, key: str) -> list[Any]:
        rows = self.data.get(key, [])
        if not isinstance(rows, list):
            self.problem(key, f"needs a list, not {type(rows).__name__}")
            return []
        return cast("list[Any]", rows)

    def general(self, doc: Document) -> Document:
        doc = self.attempt(
            "time_unit", doc, lambda d: edit.describe(d, time_unit=self.data.get("time_unit", "ms"))
        )
        doc = self.attempt("dt", doc, lambda d: edit.describe(d, dt=self.data.get("dt")))
        doc = self.attempt("t0", doc, lambda d: edit.describe(d, t0=self.data.get("t0", 0.0)))
        notes, layout = self.text("notes", ""), self.table("layout")
        return self.attempt("", doc, lambda d: edit.describe(d, notes=notes, layout=layout))

    def axes(self) -> dict[str, Axis]:
        out: dict[str, Axis] = {}
        for key, axis in self.table("axes").items():
            if not isinstance(axis, dict):
                self.problem(f"axes.{key}", f"needs an object, not {show(axis)}")
                continue
            try:
                arguments: dict[str, Any] = {"name": key} | axis
                out[key] = Axis(**arguments)
            except (AxesError, UnknownName) as error:
                self.add(Problem(f"axes.{key}", p.what, p.fix) for p in error.problems)
        return out

    def elements(self, doc: Document, axes: Mapping[str, Axis]) -> Document:
        entries: dict[str, Entry] = {}
        for path, element in self.table("elements").items():
            try:
                entry = self.entry(path, element, axes, entries)
            except (ParameterError, UnknownName) as error:
                self.add(error.problems)
            else:
                entries[entry.id] = entry
        counts = Counter(e.names for e in entries.values())
        for e in {e.names: e for e in entries.values() if counts[e.names] > 1}.values():
            self.problem(f"elements.{e.path}", "occurs twice, in two spellings")
        for e in entries.values():
            if any(e.names[:k] in counts for k in range(1, len(e.names))) or not all(e.names):
                self.problem(f"elements.{e.path}", "lies inside an element; only groups contain elements")
        return dc.replace(
            doc, entries=tuple(entries.values()), groups=_groups(e.group for e in entries.values())
        )

    def entry(self, path: str, element: Any, axes: Mapping[str, Axis], ids: Collection[str]) -> Entry:
        """Return the element at a path; `ids` are those of the elements before it."""
        where = f"elements.{path}"
        if not isinstance(element, dict):
            raise ParameterError(f"needs an object, not {show(element)}", where)
        body = dict(cast("dict[str, Any]", element))
        ident, every = body.pop("id", None), body.pop("every", 1)
        if "name" in body:
            raise ParameterError("a name is the last part of the path, not a parameter", f"{where}.name")
        names = split(path)
        part = part_from_json(body, path, axes, self.arrays, Element, names[-1])
        if ident is None:
            ident = stored_id(display(names), ids)
        if not isinstance(ident, str) or not IDENT.fullmatch(ident):
            raise ParameterError(f"is {show(ident)}; expected eight hexadecimal digits", f"{where}.id")
        if ident in ids:
            raise ParameterError(f"{ident} belongs to another element too", f"{where}.id")
        edit.require_ticks(every, where)
        return Entry(ident, names, part, every)

    def groups(self, doc: Document) -> Document:
        listed: list[PathNames] = []
        for g in self.rows("groups"):
            if not isinstance(g, str) or not g:
                self.problem("groups", f"needs paths, not {show(g)}")
                continue
            doc = self.attempt(f"groups.{g}", doc, lambda d, g=g: edit.group(d, split(g)))
            listed.append(split(g))
        # groups keep the order that the file states, not that of the elements in them
        return dc.replace(doc, groups=_groups([*(g for g in listed if g in doc.groups), *doc.groups]))

    def connections(self, doc: Document) -> Document:
        for k, row in enumerate(self.rows("connections")):
            where = f"connections.{k}"
            if len(self.problems) >= MOST_PROBLEMS:
                self.problem(
                    where,
                    f"this one and those after it were not read: there are {MOST_PROBLEMS} problems"
                    " before it",
                )
                break
            if not isinstance(row, dict) or not all(
                isinstance(cast(Any, row).get(key), str) for key in ("source", "target")
            ):
                self.problem(where, "needs a source and a target")
                continue
            ends = cast("dict[str, str]", row)
            strange = [key for key in ends if key not in ("source", "target", "reads")]
            if strange:
                self.problem(where, f"{strange[0]!r} is no property of a connection")
                continue
            doc = self.attempt(where, doc, lambda d, v=ends: _connected(d, v))
        return doc

    def parameters(self, doc: Document) -> Document:
        for name, shared in self.table("parameters").items():
            where = f"parameters.{name}"
            body = cast("dict[str, Any]", shared) if isinstance(shared, dict) else {}
            number, links = body.get("value"), body.get("links", [])
            texts = isinstance(links, list) and all(
                isinstance(path, str) for path in cast("list[Any]", links)
            )
            if (
                isinstance(number, bool)
                or not isinstance(number, (int, float))
                or not texts
                or set(body) - {"value", "links"}
            ):
                self.problem(where, "needs a value (a number) and links (a list of paths), and nothing else")
                continue
            doc = self.attempt(where, doc, lambda d, n=name, v=number: edit.document_parameter(d, n, v))
            for path in cast("list[Any]", links):
                doc = self.attempt(where, doc, lambda d, n=name, p=path: _linked(d, p, n))
        return doc

    def uses(self, doc: Document) -> Document:
        for path, use in self.table("uses").items():
            where = f"uses.{path}"
            body = cast("dict[str, Any]", use) if isinstance(use, dict) else {}
            template, elements = body.get("template"), body.get("elements")
            texts = isinstance(elements, dict) and all(
                isinstance(v, str) for v in cast("dict[str, Any]", elements).values()
            )
            if (
                not isinstance(template, str)
                or not template
                or not texts
                or set(body) - {"template", "elements"}
            ):
                self.problem(
                    where,
                    "needs a template (its name) and elements (the template's ids and paths here), and"
                    " nothing else",
                )
                continue
            pairs = cast("dict[str, str]", elements)
            doc = self.attempt(
                where, doc, lambda d, p=path, n=template, e=pairs: edit.link_group(d, split(p), n, e)
            )
        return doc


def _connected(doc: Document, row: Mapping[str, str]) -> Document:
    source, source_port = find.port(doc, row["source"])
    target, target_port = find.port(doc, row["target"], "")
    reads = row.get("reads", "")
    if reads not in READS:
        raise DocumentError(f"reads is {show(reads)}; expected previous, current or delayed")
    return edit.connect(doc, source, source_port, target, target_port, reads)


def _linked(doc: Document, path: str, name: str) -> Document:
    target = find.target(doc, path)
    if target.entry is None:
        raise UnknownName(f"{path!r} names no parameter of an element")
    if target.parameter not in [leaf for leaf, _, _ in leaves(target.entry.element)]:
        raise UnknownName(f"{path!r} is not a number that can change while the model runs")
    return edit.link(doc, target.entry.id, target.parameter, name)


def _groups(groups: Any) -> tuple[PathNames, ...]:
    out: list[PathNames] = []
    for g in groups:
        out += [g[:k] for k in range(1, len(g) + 1) if g[:k] not in out]
    return tuple(out)


def _package(kind: str) -> str:
    registry.kind(kind)
    return registry.package(kind)
