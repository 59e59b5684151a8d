"""The differences between two documents of one structure: leaves with new values."""

from __future__ import annotations

import numpy as np

from deodar.leaves import parameter_leaves
from deodar.model.document import Document, Leaf
from deodar.parameters import Parameter, parameters

LeafChange = tuple[Leaf, float | np.ndarray, Parameter]
"""A leaf with a new value, that value, and its declaration."""


def changed_leaves(old: Document, new: Document) -> list[LeafChange]:
    """Return the leaves with a new value; parameters that are the same objects are skipped."""
    entries = old.by_id()
    out: list[LeafChange] = []
    for after in new.entries:
        before = entries[after.id]
        if before.element is after.element:
            continue
        for p in parameters(type(before.element)):
            a, b = getattr(before.element, p.name), getattr(after.element, p.name)
            if a is not b:
                values = {path: value for path, value, _ in parameter_leaves(p, a)}
                out += [
                    ((after.id, path), value, declared)
                    for path, value, declared in parameter_leaves(p, b)
                    if _differ(value, values[path])
                ]
    return out


def _differ(a: float | np.ndarray, b: float | np.ndarray) -> bool:
    """Return whether two values of a leaf are unequal."""
    return bool(np.any(a != b)) if isinstance(a, np.ndarray) or isinstance(b, np.ndarray) else a != b
