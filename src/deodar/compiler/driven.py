"""The leaves that a parameter path drives: numbers, or an array."""

from __future__ import annotations

from deodar.compiler.plan import Leaf
from deodar.errors import ParameterError
from deodar.leaves import get, leaves
from deodar.model import find
from deodar.model.document import Document


def driven(doc: Document, path: str) -> list[Leaf]:
    """Return the numbers of the compiled program that a parameter, or a document parameter, drives.

    Raises:
        ParameterError: changing the parameter needs another program, or it drives no number.
    """
    found = find.target(doc, path)
    if found.entry is None:
        links = next(k.links for k in doc.parameters if k.name == found.document_parameter)
        if not links:
            raise ParameterError(
                f"the document parameter {path!r} drives nothing",
                fix="Link something to it: model.link(path, name)",
            )
        return list(links)
    get(found.entry.element, found.parameter)
    known = {leaf: p for leaf, _, p in leaves(found.entry.element) if p.form != "array"}
    inside = [leaf for leaf in known if leaf == found.parameter or leaf.startswith(found.parameter + ".")]
    if not inside:
        raise ParameterError(
            "cannot be swept: changing it makes another program",
            where=path,
            fix=f"Sweep one of: {', '.join(known)}",
        )
    return [(found.entry.id, leaf) for leaf in inside]


def array_leaf(doc: Document, path: str) -> Leaf | None:
    """Return the leaf that a parameter is, if it is an array with values; else None."""
    found = find.target(doc, path)
    if found.entry is None:
        return None
    arrays = {leaf for leaf, _, p in leaves(found.entry.element) if p.form == "array"}
    return (found.entry.id, found.parameter) if found.parameter in arrays else None
