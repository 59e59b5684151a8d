"""New elements, as an editor makes them from a kind: with axes and values that work at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from deodar import registry
from deodar.declarations import Needed
from deodar.element import Element
from deodar.errors import ParameterError
from deodar.model import document_files, plain_values
from deodar.model.document import Document
from deodar.model.parts import part_from_json
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import Parameter, an, parameters

FIRST = Axis("x", 0, 100, samples=101)
"""The axis of the first element of a document."""


def element(
    doc: Document,
    kind: str,
    name: str,
    values: Mapping[str, Any],
    axes: Axes | None = None,
    arriving: Axes | None = None,
) -> Element:
    """Return a new element of a kind.

    Args:
        doc: the document that the element is made for.
        kind: name of the kind.
        name: name of the element.
        values: parameters in the format of documents, axes by their keys; others have starting values.
        axes: its axes; None: those of the first element with a state and axes, a spare one, or a new axis.
        arriving: axes of its input; None: unknown.

    Raises:
        UnknownName: no kind has that name.
        ParameterError: the kind is no element, or a value is refused; the error lists all.
    """
    cls = registry.kind(kind)
    if not issubclass(cls, Element):
        raise ParameterError(f"expected an element, got {an(kind)}", where=kind)
    table = document_files.axes(doc)
    values = {k: plain_values.keyed(cls, k, v, table) for k, v in values.items()}
    free = usual_axes(doc) if axes is None else axes
    body: dict[str, Any] = {**values, "kind": kind}
    example, state_axes = cls.example(), free
    for p in parameters(cls):
        if p.name not in values:
            needed = _needed_axes(p, getattr(example, p.name), free)
            if needed is not None:
                keys = [document_files.axis_key(table, axis) for axis in needed]
                body[p.name] = keys if p.form == "axes" else keys[0]
        if p.name == "axes":
            keys = body.get("axes", [])
            listed = keys if isinstance(keys, list) else []
            state_axes = tuple(table[key] for key in listed if isinstance(key, str) and key in table)
    begun = {k: v for k, v in cls.starting_values(state_axes, arriving).items() if k not in values}
    return part_from_json(body, name, table, {}, Element, name, begun)


def usual_axes(doc: Document) -> Axes:
    """Return the axes of the first element that has a state and axes, else of the first with axes.

    Without such an element it is the first spare axis; a document without axes gets a new one.
    """
    with_axes = [(e.element.stateful, axes) for e in doc.entries if (axes := _axes(e.element))]
    return next(
        (axes for state, axes in with_axes if state),
        with_axes[0][1] if with_axes else doc.spare_axes[:1] or (FIRST,),
    )


def _axes(element: Element) -> Axes:
    axes: Sequence[Axis] = getattr(element, "axes", ())
    return tuple(axes)


def _needed_axes(p: Parameter, example: Any, axes: Axes) -> Axes | None:
    """Return the axes that a new element gets for a parameter; None: the parameter keeps its default."""
    if p.form == "axes" and example:
        return axes
    if p.form == "axis" and isinstance(p.default, Needed):
        return (example,)
    return None


def kinds() -> Iterator[type[Element]]:
    """Yield every registered kind of element."""
    yield from (cls for cls in registry.kinds().values() if issubclass(cls, Element))
