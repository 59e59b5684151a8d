"""Convert documents of older versions to the present version: plain data in, plain data out.

Version 1: some elements had an axis as a default, and a document could leave it out. Version 2 states every
axis. Version 3 renames parameters. Until version 3 a stimulus with an empty list of time windows was always
on; since version 4 it is never on, and null means always. Version 4 also has another rule `cell` for the
output of a field; the rule of older versions is `cell-0.1` there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

from deodar import registry
from deodar.codec import Json
from deodar.element import Element
from deodar.errors import UnknownName
from deodar.model import find
from deodar.model.document import Document
from deodar.model.kept_presets import PRESETS
from deodar.parameters import Parameter, parameters

WINDOWS = "windows"
"""The parameter of stimuli whose empty list has another meaning since version 4."""

QUADRATURE = "quadrature"
"""The parameter of fields whose value "cell" is another rule since version 4."""

VALUES_CHANGED = 4
"""The version of documents since which values of these parameters have another meaning."""

AxisData = Mapping[str, Any]

_X: AxisData = {"name": "x", "lower": 0, "upper": 20, "samples": 21}
_TARGET: AxisData = {"name": "target", "lower": 0, "upper": 12, "samples": 13}

DEFAULTS_OF_1: Mapping[str, Mapping[str, tuple[AxisData, ...]]] = {
    "AdaptiveWeights": {"axes": (_TARGET,)},
    "Attractor": {"axis": ({"name": "x", "lower": 0, "upper": 100, "samples": 101},)},
    "DiagonalExpansion": {
        "axes": (
            {"name": "x", "lower": 0, "upper": 10, "samples": 11},
            {"name": "y", "lower": 0, "upper": 10, "samples": 11},
        )
    },
    "DiagonalSum": {"axes": ({"name": "sum", "lower": 0, "upper": 28, "samples": 29},)},
    "Hebbian": {"axes": (_TARGET,)},
    "History": {"slots": ({"name": "slot", "lower": 0, "upper": 9, "samples": 10},)},
    "Pattern": {"axes": (_X,)},
    "PeakPosition": {"axis": (_X,)},
    "PopulationActivity": {"axes": (_X,)},
    "RateCode": {"axes": (_X,)},
    "SampledHistory": {"slots": ({"name": "slot", "lower": 0, "upper": 2, "samples": 3},)},
    "SpaceCode": {"axes": (_X,)},
    "TimeSeries": {"axes": (_X,)},
    "Weighting": {"axes": (_X,)},
    "Weights": {"axes": (_X,)},
}
"""Axes that elements of version 1 had where a document left them out, by kind and parameter."""

RENAMED_AFTER_2: Mapping[str, Mapping[str, str]] = {"MovingGaussian": {"path": "waypoints"}}
"""Parameters of versions 1 and 2 that version 3 renamed, by kind: old name to new name."""


def migrate(document: Mapping[str, Json]) -> dict[str, Json]:
    """Convert a document of an older version; a document of the present version is returned unchanged.

    Data of an unexpected form are not changed: the reader reports them.
    """
    version = document.get("deodar")
    if version == 1:
        document = _from_1(document)
    if version in (1, 2):
        document = _from_2(document)
    return _from_3(document) if version in (1, 2, 3) else dict(document)


def recorded(doc: Document, path: str) -> str:
    """Convert a recorded path of versions 1 and 2, where the path of a field alone meant its output.

    Now it means the activation.
    """
    try:
        entry, port = find.port(doc, path, "")
    except UnknownName:  # the sensor of a world, or a mistake that the reader of the path reports
        return path
    return path if port or "activation" not in find.outputs(entry) else f"{path}.output"


def _from_1(document: Mapping[str, Json]) -> dict[str, Json]:
    axes, elements = document.get("axes", {}), document.get("elements")
    if not isinstance(axes, dict) or not isinstance(elements, dict):
        return dict(document)
    axes, elements = dict(cast("dict[str, Any]", axes)), dict(cast("dict[str, Any]", elements))
    for path, body in elements.items():
        kind = cast("dict[str, Any]", body).get("kind") if isinstance(body, dict) else None
        missing = (
            {name: old for name, old in DEFAULTS_OF_1.get(kind, {}).items() if name not in body}
            if isinstance(kind, str)
            else {}
        )
        for name, old in missing.items():
            keys = [_key(axes, axis) for axis in old]
            elements[path] = elements[path] | {name: keys[0] if name in ("axis", "slots") else keys}
    return {**document, "axes": axes, "elements": elements}


def _from_2(document: Mapping[str, Json]) -> dict[str, Json]:
    elements = document.get("elements")
    if not isinstance(elements, dict):
        return dict(document)
    elements = dict(cast("dict[str, Any]", elements))
    for path, body in elements.items():
        kind = cast("dict[str, Any]", body).get("kind") if isinstance(body, dict) else None
        renamed = RENAMED_AFTER_2.get(kind, {}) if isinstance(kind, str) else {}
        if renamed and not renamed.keys().isdisjoint(body):
            elements[path] = {renamed.get(key, key): value for key, value in body.items()}
    return {**document, "elements": elements}


def _from_3(document: Mapping[str, Json]) -> dict[str, Json]:
    elements, layout = document.get("elements"), document.get("layout")
    out = dict(document)
    if isinstance(elements, dict):
        bodies = cast("dict[str, Any]", elements)
        out["elements"] = {path: _body_of_3(body) for path, body in bodies.items()}
    presets = cast("dict[str, Any]", layout).get(PRESETS) if isinstance(layout, dict) else None
    if isinstance(presets, list):
        kinds = _kinds_by_id(elements)
        listed = [_preset(preset, kinds) for preset in cast("list[Any]", presets)]
        out["layout"] = {**cast("dict[str, Any]", layout), PRESETS: listed}
    return out


def _body_of_3(body: Any) -> Any:
    kind = cast("dict[str, Any]", body).get("kind") if isinstance(body, dict) else None
    return values_of_3(body, lambda _: _class_of(kind))


def _kinds_by_id(elements: Any) -> dict[Any, type[Element] | None]:
    """Return the classes of elements that state their ids, as all do that a file of deodar holds."""
    bodies = cast("dict[str, Any]", elements).values() if isinstance(elements, dict) else ()
    stated = [cast("dict[str, Any]", body) for body in bodies if isinstance(body, dict)]
    return {str(body.get("id")): _class_of(body.get("kind")) for body in stated}


def _preset(preset: Any, kinds: Mapping[Any, type[Element] | None]) -> Any:
    values = cast("dict[str, Any]", preset).get("values") if isinstance(preset, dict) else None
    if not isinstance(values, dict):
        return preset
    by_element = cast("dict[str, Any]", values)
    converted = {
        ident: values_of_3(inner, lambda _, ident=ident: kinds.get(ident))
        for ident, inner in by_element.items()
    }
    return {**preset, "values": converted}


KindOf = Callable[[str], type[Element] | None]
"""A function that returns the class of the element whose parameter a path names; None: it is not known."""


def values_of_3(values: Any, kind_of: KindOf) -> Any:
    """Convert the values of parameters before document version 4, by name or path."""
    if not isinstance(values, dict):
        return values
    by_path = cast("dict[str, Any]", values)
    return {path: value_of_3(path, plain, kind_of) for path, plain in by_path.items()}


def value_of_3(path: Any, plain: Any, kind_of: KindOf) -> Any:
    """Convert the value of one parameter before document version 4, of which the name or path is known.

    Without windows a stimulus was always on, and `cell` was the rule `cell-0.1`. A parameter of the same name
    that cannot have the converted value belongs to a kind of a package and keeps its value.
    """
    name = path.rpartition(".")[2] if isinstance(path, str) else ""
    if name == WINDOWS and plain in ([], ()):
        declared = _declared(kind_of(path), name)
        return None if declared is None or declared.optional else plain
    if name == QUADRATURE and plain == "cell":
        declared = _declared(kind_of(path), name)
        return "cell-0.1" if declared is None or "cell-0.1" in declared.choices else plain
    return plain


def kind_lookup(doc: Document | None) -> KindOf:
    """Return the function that looks elements up in a document; without a document none is known."""

    def kind_of(path: str) -> type[Element] | None:
        try:
            entry = None if doc is None else find.target(doc, path).entry
        except UnknownName:  # the reader of the path reports it
            return None
        return None if entry is None else type(entry.element)

    return kind_of


def _class_of(kind: Any) -> type[Element] | None:
    """Return the class of a kind; None: there is none, which the reader of the document reports."""
    try:
        return registry.kind(kind) if isinstance(kind, str) else None
    except UnknownName:
        return None


def _declared(kind: type[Element] | None, name: str) -> Parameter | None:
    return None if kind is None else next((p for p in parameters(kind) if p.name == name), None)


def _key(axes: dict[str, Json], axis: AxisData) -> str:
    """Return the key of the axis in the document; an axis that the document lacks is added."""
    name, k = axis["name"], 1
    key = name
    while key in axes and axes[key] != axis:
        k += 1
        key = f"{name}{k}"
    axes[key] = dict(axis)
    return key
