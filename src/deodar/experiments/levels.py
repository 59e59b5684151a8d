"""What a parameter path drives, and whether trials of one batch may differ in it."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.compiler.plan import Leaf, cost
from deodar.errors import ParameterError
from deodar.leaves import get, leaves
from deodar.model import find
from deodar.model.document import Document
from deodar.parameters import real


def leaves_of(doc: Document, path: str) -> list[Leaf]:
    """The numbers of the compiled program that a parameter, or a parameter of the document, drives; refused where it makes another program."""
    found = find.target(doc, path)
    if found.entry is None:
        return list(next(k.links for k in doc.knobs if k.name == found.knob))
    get(found.entry.element, found.parameter)
    known = [leaf for leaf, _, p in leaves(found.entry.element) if p.form != "array"]
    inside = [leaf for leaf in known if leaf == found.parameter or leaf.startswith(found.parameter + ".")]
    if not inside:
        raise ParameterError("cannot differ inside a batch: changing it makes another program", where=path)
    return [(found.entry.id, leaf) for leaf in inside]


def swept(doc: Document, path: str, values: Iterable[object]) -> bool:
    """Whether copies of one batch may have these values: numbers for live parameters, of which none switches something off.

    Copies that differ in a parameter that rebuilds, such as a kernel's width, would each need matrices of their own.
    """
    given = [real(v) for v in values]
    if any(v is None for v in given):
        return False
    try:
        driven = leaves_of(doc, path)
    except ParameterError:
        return False
    by = doc.by_id()
    declared = [next(p for leaf, _, p in leaves(by[i].element) if leaf == inner) for i, inner in driven]
    return bool(driven) and not any(cost(p) != "live" or (p.off and v == p.neutral) for p in declared for v in given)
