"""Conversion of documents, parameters and problems to messages for the page."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

from deodar.element import Element
from deodar.errors import Problem as Wrong
from deodar.experiments.design import KINDS, USUAL, Design
from deodar.kinds.description import describe, descriptions
from deodar.model import files, find, starting
from deodar.model.check import check
from deodar.model.document import Document, Entry
from deodar.model.fits import Fit, FittingKind
from deodar.model.parts import value_from_json
from deodar.model.resolve import Node, resolve
from deodar.numerics.axes import Axis
from deodar.parameters import FrozenArray, Part
from deodar.recording.first_difference import FirstDifference
from deodar.recording.replay import RecordReader
from deodar.server.comparison import RecordComparison
from deodar.server.to_page import (
    AxisView,
    Comparison,
    ConnectionView,
    CopyDimension,
    DifferenceView,
    DocumentParameterView,
    DocumentView,
    ElementView,
    ExperimentForms,
    Fits,
    FittingKindView,
    FitView,
    Kind,
    LinkView,
    ListedProblem,
    OfferView,
    RecordView,
)
from deodar.server.to_server import FindFits

BESIDE = ("kind", "id", "every")
"""Keys of an element in a document that are not parameters."""


LOOKS = ("panels", "folded")
"""Keys of the layout whose changes do not count as unsaved edits: positions of panels, folded groups."""


def kinds() -> list[Kind]:
    """Return the description of every registered kind as a message."""
    return [msgspec.convert(kind, Kind, from_attributes=True) for kind in descriptions()]


def experiment_forms() -> ExperimentForms:
    """Return the descriptions of the parts of an experiment, those of packages included."""

    def forms(family: Mapping[str, type[Part]]) -> list[Kind]:
        return [msgspec.convert(describe(cls, {}), Kind, from_attributes=True) for cls in family.values()]

    [design] = forms({"": Design})
    kept = [form for form in design.parameters if form.name not in ("model", *KINDS)]
    return ExperimentForms(
        design=kept,
        conditions=forms(KINDS["conditions"]),
        actions=forms(KINDS["actions"]),
        measures=forms(KINDS["measures"]),
        usual=USUAL["measures"],
    )


def document(doc: Document, file: str, unsaved: bool, undo: int, redo: int) -> DocumentView:
    """Convert a whole document."""
    data, arrays = files.to_data(doc)
    nodes = {n.id: n for n in resolve(doc)[0] if n.declared}
    named = {_axis(data["axes"][key]): key for key in data["axes"]}
    return DocumentView(
        file=file,
        title=doc.name,
        time_unit=doc.time_unit,
        dt=doc.dt,
        notes=doc.notes,
        axes=[axis(a, key) for a, key in named.items()],
        elements=[
            _element(e, _with_ranges(data["elements"][e.path], arrays), nodes.get(e.id), named)
            for e in doc.entries
        ],
        connections=[
            ConnectionView(
                source=c.source,
                source_port=c.source_port,
                target=c.target,
                target_port=c.target_port,
                reads=c.reads,
            )
            for c in doc.connections
        ],
        groups=[list(g) for g in doc.groups],
        parameters=[
            DocumentParameterView(
                name=k.name, value=k.value, links=[LinkView(element=i, parameter=p) for i, p in k.links]
            )
            for k in doc.parameters
        ],
        layout=dict(doc.layout),
        problems=problems(check(doc), doc),
        unsaved=unsaved,
        undo=undo,
        redo=redo,
    )


def record(reader: RecordReader, path: str) -> RecordView:
    """Convert a record: its state, its trials and sweep, and the recorded ports."""
    ports: dict[str, list[str]] = {}
    for ident, port in reader.ports:
        ports.setdefault(ident, []).append(port)
    copies = [
        CopyDimension(name=name, values=[f"{v:g}" for v in values.tolist()])
        for name, values in reader.copies.items()
    ]
    return RecordView(path=path, complete=reader.complete, notes=reader.notes, copies=copies, ports=ports)


NO_COMPARISON = Comparison(path="", progress=0.0, compared=0, differences=[], notes=[], problems=[])


def comparison(found: RecordComparison, path: str) -> Comparison:
    """Convert a comparison of two records."""
    return Comparison(
        path=path,
        progress=found.progress,
        compared=len(found.ports),
        differences=[_difference(found.record, d) for d in found.differences],
        notes=found.notes,
        problems=problems(found.problems),
    )


def fits(m: FindFits, ports: Iterable[Fit], kinds: Iterable[FittingKind]) -> Fits:
    """Convert what a port can be connected with."""
    shown = [
        FitView(
            element=f.element,
            port=f.port,
            fits=f.fits,
            reason=f.reason,
            offers=[OfferView(kind=o.kind, values=dict(o.values), note=o.note) for o in f.offers],
        )
        for f in ports
    ]
    found = [FittingKindView(kind=k.kind, port=k.port) for k in kinds]
    return Fits(request=m.request, element=m.element, port=m.port, ports=shown, kinds=found)


def _difference(reader: RecordReader, found: FirstDifference) -> DifferenceView:
    axes = reader.axes(found.place)
    at = ", ".join(
        f"{a.name} {a.points[i]:g} {a.unit}".rstrip() for a, i in zip(axes, found.index, strict=True)
    )
    value, other = (v if math.isfinite(v) else None for v in found.values)
    return DifferenceView(
        element=found.place[0],
        path=found.path,
        time=found.time,
        copy=dict(found.copy),
        at=at,
        value=value,
        other=other,
    )


def axis(a: Axis, key: str = "") -> AxisView:
    """Convert an axis; `key` is its key in the document, empty if it has none."""
    return AxisView(
        key=key,
        name=a.name,
        lower=a.lower,
        upper=a.upper,
        samples=a.samples,
        periodic=a.periodic,
        unit=a.unit,
    )


def problems(
    found: Iterable[Wrong], doc: Document | None = None, paths: Sequence[str] = ()
) -> list[ListedProblem]:
    """Convert problems, each once for every element concerned: those named in its `where`, or in `paths`."""
    entries = doc.entries if doc is not None else ()
    out: list[ListedProblem] = []
    for p in found:
        concerned = [e.id for path in (p.where, *paths) for e in entries if _names(path, e.path)] or [""]
        out += [
            ListedProblem(what=p.what, where=p.where, fix=p.fix, element=ident, severity=p.severity)
            for ident in dict.fromkeys(concerned)
        ]
    return out


def _names(where: str, path: str) -> bool:
    """Return whether the `where` of a problem names an element: `u`, `u.tau` or `u (script.py:3)`."""
    return where == path or where.startswith((f"{path}.", f"{path} ("))


def _element(e: Entry, data: Mapping[str, Any], node: Node | None, named: Mapping[Axis, str]) -> ElementView:
    ports = {} if node is None else {**node.ins, **node.outs}
    return ElementView(
        id=e.id,
        path=e.path,
        name=e.names[-1],
        group=list(e.group),
        kind=type(e.element).__name__,
        every=e.every,
        values={k: v for k, v in data.items() if k not in BESIDE},
        inputs=list(e.element.ports()),
        outputs=find.outputs(e),
        axes={port: [named.get(a, a.name) for a in axes] for port, axes in ports.items()},
        pushable=e.every == 1 and type(e.element).inject is not Element.inject,
        kernel=e.element.convolution is not None and len(e.element.kernels()) > 0,
    )


def _with_ranges(value: Any, arrays: Mapping[str, FrozenArray]) -> Any:
    """Return a value with the shape and the range of every array that it refers to."""
    if isinstance(value, list):
        return [_with_ranges(v, arrays) for v in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"array"} and value["array"] in arrays:
        content = arrays[value["array"]].data
        return value | {
            "shape": list(content.shape),
            "min": float(content.min()),
            "max": float(content.max()),
        }
    return {key: _with_ranges(v, arrays) for key, v in value.items()}


def _axis(data: Mapping[str, Any]) -> Axis:
    return Axis(**data)


def read_value(doc: Document, entry: Entry, parameter: str, value: Any) -> Any:
    """Convert a parameter's value from the page to the form of the document."""
    axes = files.axes(doc)
    if "." not in parameter:
        value = starting.keyed(type(entry.element), parameter, value, axes)
    arrays = files.to_data(doc)[1] if _names_array(value) else {}
    return value_from_json(entry.element, parameter, value, f"{entry.path}.{parameter}", axes, arrays)


def _names_array(value: Any) -> bool:
    """Return whether plain data refer to an array of the document."""
    if isinstance(value, dict):
        return "array" in value or any(_names_array(v) for v in value.values())
    return isinstance(value, list) and any(_names_array(v) for v in value)


def shown_value(doc: Document, element: str, parameter: str) -> Any:
    """Convert the value of a parameter for the page."""
    data, arrays = files.to_data(doc)
    value = _with_ranges(data["elements"][doc.by_id()[element].path], arrays)
    for step in parameter.split("."):
        value = value[int(step)] if isinstance(value, list) else value[step]
    return value


def plain(doc: Document) -> Document:
    """Return the document without the keys of its layout that do not count as edits."""
    return dc.replace(doc, layout={k: v for k, v in doc.layout.items() if k not in LOOKS})
