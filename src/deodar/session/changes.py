"""The differences between two documents of one structure: leaves with new values, and the cost of each."""

from __future__ import annotations

import numpy as np

from deodar.compiler.plan import cost
from deodar.element import Element
from deodar.leaves import leaves, structure
from deodar.model.document import Document
from deodar.parameters import parameters

LeafChange = tuple[tuple[str, str], float | np.ndarray, str, bool]
"""A leaf with a new value: (id, path), value, cost, and whether that value switches something off."""


def changed_leaves(old: Document, new: Document) -> list[LeafChange] | None:
    """Return the leaves with a new value, and the cost of each; None if more than leaves changed."""
    if old.connections != new.connections or len(old.entries) != len(new.entries):
        return None
    out: list[LeafChange] = []
    for before, after in zip(old.entries, new.entries, strict=True):
        if before is after:
            continue
        if (before.id, before.every) != (after.id, after.every):
            return None
        if before.element is not after.element:
            changed = _of_element(before.element, after.element)
            if changed is None:
                return None
            out += [((after.id, path), value, cost, off) for path, value, cost, off in changed]
    return out


def _of_element(old: Element, new: Element) -> list[tuple[str, float | np.ndarray, str, bool]] | None:
    """Return the changed leaves of one element; parameters that are the same objects are skipped."""
    if type(old) is not type(new):
        return None
    moved = {p.name: p for p in parameters(type(old)) if getattr(old, p.name) is not getattr(new, p.name)}
    plain = all(
        p.traced and isinstance(getattr(old, name), float) and isinstance(getattr(new, name), float)
        for name, p in moved.items()
    )
    if not plain and structure(old) != structure(new):
        return None
    old_values = {path: value for path, value, _ in leaves(old, only=moved)}
    new_leaves = [(path, value, p) for path, value, p in leaves(new, only=moved) if path in old_values]
    return [
        (path, value, cost(p), p.off and value == p.neutral)
        for path, value, p in new_leaves
        if value is not old_values[path] and np.any(value != old_values[path])
    ]
