"""The leaves that a parameter path drives: numbers, or an array."""

from __future__ import annotations

from deodar.errors import ParameterError
from deodar.leaves import get, leaves
from deodar.model import find
from deodar.model.document import Document, Leaf


def driven(doc: Document, path: str) -> list[Leaf]:
    """Return the numbers of the compiled program that a parameter, or a document parameter, drives.

    Raises:
        ParameterError: changing the parameter needs another program, or it drives no number.
    """
    target = find.target(doc, path)
    if target.entry is None:
        links = next(k.links for k in doc.parameters if k.name == target.parameter)
        if not links:
            raise ParameterError(
                f"the document parameter {path!r} drives nothing",
                fix="Link something to it: model.link(path, name)",
            )
        return list(links)
    get(target.entry.element, target.parameter)
    numbers = {leaf: p for leaf, _, p in leaves(target.entry.element) if p.form != "array"}
    inside = [leaf for leaf in numbers if leaf == target.parameter or leaf.startswith(target.parameter + ".")]
    if not inside:
        raise ParameterError(
            "cannot be swept: changing it makes another program",
            where=path,
            fix=f"Sweep one of: {', '.join(numbers)}",
        )
    return [(target.entry.id, leaf) for leaf in inside]


def array_leaf(doc: Document, path: str) -> Leaf | None:
    """Return the leaf that a parameter is, if it is an array with values; else None."""
    target = find.target(doc, path)
    if target.entry is None:
        return None
    arrays = {leaf for leaf, _, p in leaves(target.entry.element) if p.form == "array"}
    return (target.entry.id, target.parameter) if target.parameter in arrays else None
