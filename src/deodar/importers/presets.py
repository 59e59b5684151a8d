"""Apply the parameter values of one file to an open model (a preset in cosivina)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from deodar.errors import DeodarError
from deodar.importers.opening import load, tool_of
from deodar.importers.report import ImportReport, Line
from deodar.leaves import get
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar.model.kept_presets import KeptPreset, kept_presets, take_preset
from deodar.model.model import Model
from deodar.numerics.axes import Axes, describe
from deodar.numerics.convolution import boundaries
from deodar.parameters import Part, parameters

STRUCTURE = ("name", "axes")
"""Properties that a preset does not change."""

ENDS = "boundary"
"""Nor the boundaries: whether the axes themselves wrap is read from a whole file, and a preset may be a part
of one.
"""


def apply_preset(model: Model, path: str | Path, bugs: bool = False) -> ImportReport:
    """Set the parameters of a model to the values of one of its presets, or to those that elements of the
    same label and class have in a file.

    Connections do not change.

    The change is one step of the model's history. A session applies it by `model.document`.

    Args:
        model: an open model.
        path: the name of a preset that the document has, as a launcher of cosivina gives them; otherwise a
            file of another tool, or a document of deodar.
        bugs: whether to reproduce known errors of the other tool instead of correcting them.

    Returns:
        A report: every changed parameter is `carried`; elements and parameters without a match, on either
        side, are `dropped`.

    Raises:
        DocumentError: the file cannot be read; the model is then unchanged.
    """
    own = next((p for p in kept_presets(model.document) if p.name == path), None)
    if own is not None:
        doc, lines = kept(model.document, own)
        model.history.commit(doc)
        return ImportReport("deodar", own.name, lines)
    tool = tool_of(path)
    doc, lines = applied(model.document, load(path, bugs=bugs).document)
    model.history.commit(doc)
    return ImportReport(tool.NAME if tool is not None else "deodar", Path(path).name, lines)


def kept(doc: Document, preset: KeptPreset) -> tuple[Document, list[Line]]:
    """Return a document with the values of one of its presets, and a line about each value."""
    new, lines = take_preset(doc, preset)
    return new, [
        Line(where, "parameter", path, "dropped" if why else "carried", why) for where, path, why in lines
    ]


def applied(doc: Document, preset: Document) -> tuple[Document, list[Line]]:
    """Return a document with the values of another one, and a line about each value."""
    lines: list[Line] = []
    by = {e.names: e for e in preset.entries}
    for entry in doc.entries:
        other = by.pop(entry.names, None)
        if other is None:
            lines.append(
                Line(
                    entry.path,
                    "element",
                    type(entry.element).__name__,
                    "dropped",
                    "the file has no such element; it keeps its values",
                )
            )
            continue
        strange = _differs(entry, other)
        if strange:
            lines.append(Line(entry.path, "element", type(other.element).__name__, "dropped", strange))
            continue
        doc, changed = _values(doc, entry, other)
        lines += changed
    return doc, lines + [
        Line(e.path, "element", type(e.element).__name__, "dropped", "the model has no such element")
        for e in by.values()
    ]


def _differs(here: Entry, there: Entry) -> str:
    """Return why one element cannot take the values of the other; "" if it can."""
    if type(here.element) is not type(there.element):
        return f"is {type(there.element).__name__} in the file and {type(here.element).__name__} here"
    ours, theirs = _axes(here), _axes(there)
    if [(a.name, a.samples) for a in ours] != [(a.name, a.samples) for a in theirs]:
        return f"lies over {describe(theirs)} in the file and over {describe(ours)} here"
    return ""


def _axes(entry: Entry) -> Axes:
    return tuple(getattr(entry.element, "axes", ()))


def _ends(entry: Entry, given: Any) -> Any:
    """Return the boundaries, if an element has axes of its own that can state them."""
    own = _axes(entry)
    return boundaries(given, own) if own else given


def _values(doc: Document, here: Entry, there: Entry) -> tuple[Document, list[Line]]:
    lines: list[Line] = []
    for p in parameters(type(here.element)):
        if p.name in STRUCTURE:
            continue
        old, new = getattr(here.element, p.name), getattr(there.element, p.name)
        if old == new:
            continue
        for path, value in _leaves(old, new, p.name):
            if path.rpartition(".")[2] == ENDS:
                if _ends(here, get(here.element, path)) != _ends(there, value):
                    lines.append(
                        Line(
                            here.path,
                            "parameter",
                            path,
                            "dropped",
                            "values outside the common range are unchanged",
                        )
                    )
                continue
            try:
                doc = edit.put(doc, here.id, path, value)
            except DeodarError as error:  # a document parameter drives it
                lines.append(Line(here.path, "parameter", path, "dropped", error.problems[0].what))
            else:
                lines.append(Line(here.path, "parameter", path, "carried"))
    return doc, lines


def _leaves(old: Any, new: Any, path: str) -> list[tuple[str, Any]]:
    """Return the smallest values that differ: inside parts of the same kind, else the whole."""
    if (
        isinstance(old, tuple)
        and isinstance(new, tuple)
        and len(old) == len(new)
        and all(isinstance(v, Part) for v in (*old, *new))
    ):  # pyright: ignore
        pairs = [(a, b, f"{path}.{k}") for k, (a, b) in enumerate(zip(old, new, strict=True))]  # pyright: ignore
        if all(type(a) is type(b) for a, b, _ in pairs):
            return [leaf for a, b, inside in pairs for leaf in _leaves(a, b, inside)]
    if isinstance(old, Part) and type(old) is type(new):
        return [
            leaf
            for p in parameters(type(old))
            if getattr(old, p.name) != getattr(new, p.name)
            for leaf in _leaves(getattr(old, p.name), getattr(new, p.name), f"{path}.{p.name}")
        ]
    return [(path, new)]
