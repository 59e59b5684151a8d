"""Values of parameters as plain data, in the format of documents: what an editor sends for one parameter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, cast

from deodar.model import document_files, edit, find
from deodar.model.document import Document
from deodar.model.parts import value_from_json
from deodar.numerics.axes import Axis
from deodar.parameters import parameters


def put(doc: Document, ids: Iterable[str], path: str, data: Any) -> Document:
    """Return a document with another value of one parameter of several elements, given as plain data.

    Args:
        doc: the document.
        ids: the ids of the elements.
        path: the parameter, of the form `tau`, `kernel`, `kernel.0` or `kernel.0.sigma`.
        data: the value as documents write it: axes and arrays by their keys in `doc`, parts with their kinds.
            An axis may also be given by its properties, and an array by its numbers.

    Raises:
        UnknownName: the document has no such element, or the element no such parameter.
        ParameterError: the data are no value of this parameter, or a document parameter drives it.
    """
    new = doc
    for ident in ids:
        # a number, as a slider sends it, is its own value: no table of axes is made for it
        value = data if data is None or isinstance(data, (int, float)) else _read(doc, ident, path, data)
        new = edit.put(new, ident, path, value)
    return new


def _read(doc: Document, ident: str, path: str, data: Any) -> Any:
    entry, axes = find.entry(doc, ident), document_files.axes(doc)
    if "." not in path:
        data = keyed(type(entry.element), path, data, axes)
    arrays = document_files.arrays(doc) if _names_array(data) else {}
    return value_from_json(entry.element, path, data, f"{entry.path}.{path}", axes, arrays)


def _names_array(data: Any) -> bool:
    """Return whether plain data refer to an array of the document."""
    if isinstance(data, dict):
        return "array" in data or any(_names_array(v) for v in cast("dict[str, Any]", data).values())
    return isinstance(data, list) and any(_names_array(v) for v in cast("list[Any]", data))


def keyed(cls: type[Any], name: str, data: Any, axes: dict[str, Axis]) -> Any:
    """Return the plain data of a parameter with the keys of its axes.

    An axis may also be given by its properties, `{"name": "x", "lower": 0, "upper": 1, "samples": 51}`; it is
    added to `known`, the axes of the document by their keys.
    """
    forms = {p.name: p.form for p in parameters(cls)}
    if forms.get(name) == "axis":
        return _key(data, axes)
    if forms.get(name) == "axes" and isinstance(data, list):
        return [_key(axis_data, axes) for axis_data in cast("list[Any]", data)]
    return data


def _key(data: Any, axes: dict[str, Axis]) -> Any:
    return (
        document_files.axis_key(axes, axis(cast("dict[Any, Any]", data))) if isinstance(data, dict) else data
    )


def axis(properties: Mapping[str, Any]) -> Axis:
    """Return the axis of plain properties; raise AxesError or UnknownName for wrong ones."""
    return Axis(**{str(k): v for k, v in properties.items()})
