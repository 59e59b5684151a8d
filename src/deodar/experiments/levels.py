"""Whether trials of one batch may differ in a parameter."""

from __future__ import annotations

from collections.abc import Iterable

from deodar.batch.driven import driven
from deodar.compiler.plan import cost
from deodar.errors import ParameterError
from deodar.leaves import leaves
from deodar.model.document import Document
from deodar.parameters import real


def swept(doc: Document, path: str, values: Iterable[object]) -> bool:
    """Return whether copies of one batch may have these values.

    They may if the values are numbers of live parameters, and none of them switches a term off. Copies that
    differ in a parameter that rebuilds, such as a kernel's width, would each need their own matrices.
    """
    given = [real(v) for v in values]
    if any(v is None for v in given):
        return False
    try:
        found = driven(doc, path)
    except ParameterError:
        return False
    by = doc.by_id()
    declared = [next(p for leaf, _, p in leaves(by[i].element) if leaf == inner) for i, inner in found]
    return not any(cost(p) != "live" or (p.off and v == p.neutral) for p in declared for v in given)
