"""The differences between two documents of one structure: leaves with new values."""

from __future__ import annotations

import numpy as np

from deodar.leaves import leaves
from deodar.model.document import Document, Leaf
from deodar.parameters import Parameter, parameters

LeafChange = tuple[Leaf, float | np.ndarray, Parameter]
"""A leaf with a new value, that value, and its declaration."""


def changed_leaves(old: Document, new: Document) -> list[LeafChange]:
    """Return the leaves with a new value; parameters that are the same objects are skipped."""
    out: list[LeafChange] = []
    for after in new.entries:
        before = old.by_id()[after.id]
        a, b = before.element, after.element
        if a is b:
            continue
        moved = [p.name for p in parameters(type(a)) if getattr(a, p.name) is not getattr(b, p.name)]
        values = {path: value for path, value, _ in leaves(a, only=moved)}
        out += [
            ((after.id, path), value, p)
            for path, value, p in leaves(b, only=moved)
            if value is not values[path] and np.any(value != values[path])
        ]
    return out
