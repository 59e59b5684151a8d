"""What a parameter of cosivina sets in the translation: the numbers of elements that follow it.

Nothing is declared: an element is translated again with other values of its parameters, and the results are
compared.
"""

from __future__ import annotations

import copy
import dataclasses as dc
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, cast

from deodar.elements.placeholder import Placeholder
from deodar.parameters import Part, parameters
from deodar_interop.importers.cosivina.translate import Translation

LeafPath = tuple[str, str]
"""Name of an element, and path of a value inside it."""

STRUCTURE = ("name", "axes")

CURVED = 1e-3
"""Largest deviation from a straight line, as a share of the range, of a value that follows a slider."""


class Unfollowed(ValueError):
    """Raised if nothing can follow a parameter; the message is the reason."""


@dc.dataclass(frozen=True)
class Follower:
    """A number that follows a parameter in proportion: its values at present and at two ends."""

    leaf: LeafPath
    now: float
    lower: float
    upper: float


class Responses:
    """The translation of a file, and those of single elements with other parameters."""

    def __init__(self, translation: Translation) -> None:
        self.translation = translation
        self._present: dict[str, dict[LeafPath, Any]] = {}

    def present(self, label: str) -> dict[LeafPath, Any]:
        """Return all values of the translation of an element.

        Raises:
            Unfollowed: there is no such element, or it is a placeholder.
        """
        if label not in self._present:
            piece = self.translation.pieces.get(label)
            if piece is None:
                raise Unfollowed(f"no element has the label {label!r}")
            if isinstance(piece.elements[0], Placeholder):
                raise Unfollowed(f"{label!r} is a placeholder")
            self._present[label] = dict(v for e in piece.elements for v in _flat(e, e.name))
        return self._present[label]

    def require(self, label: str, name: str) -> None:
        """Raise an error if an element has no parameter of a name."""
        self.present(label)
        if name not in self.translation.simulator.by_label[label].values:
            kind = self.translation.simulator.by_label[label].kind
            raise Unfollowed(f"{label!r} is a {kind} without a parameter {name!r}")

    def changed(self, label: str, values: Mapping[str, Any]) -> dict[LeafPath, Any]:
        """Return all values of the translation of an element with other parameters."""
        before = self.present(label)
        element = self.translation.simulator.by_label[label]
        scratch = copy.copy(self.translation)
        scratch.met, scratch.report, scratch.names = [], [], copy.deepcopy(self.translation.names)
        piece = scratch.piece(dc.replace(element, values={**element.values, **values}))
        base = self.translation.pieces[label].elements
        if [type(e) for e in piece.elements] != [type(e) for e in base]:
            raise Unfollowed(f"{label!r} becomes other elements with {', '.join(values)}")
        leaves = dict(v for e, b in zip(piece.elements, base, strict=True) for v in _flat(e, b.name))
        if leaves.keys() != before.keys():
            raise Unfollowed(f"{label!r} has other parts with {', '.join(values)}")
        return leaves

    def followers(
        self, label: str, name: str, lower: float, upper: float
    ) -> tuple[list[Follower], list[LeafPath]]:
        """Return the numbers that follow a parameter in proportion, and values that change otherwise.

        Raises:
            Unfollowed: nothing follows it.
        """
        self.require(label, name)
        at_present = self.present(label)
        low, *inside, high = (self.changed(label, {name: lower + (upper - lower) * k / 4}) for k in range(5))
        followers: list[Follower] = []
        curved: list[LeafPath] = []
        rows = (
            (leaf, at_present[leaf], low[leaf], *(v[leaf] for v in inside), high[leaf]) for leaf in at_present
        )
        for leaf, present, first, a, b, c, last in (inner for row in rows for inner in _entries(*row)):
            if first == a == b == c == last:
                continue
            numbers = all(type(v) in (int, float) for v in (present, first, a, b, c, last))
            if numbers and a != c and abs(b - (a + c) / 2) <= CURVED * abs(c - a):  # ends may be bounds
                followers.append(Follower(leaf, float(present), float(first), float(last)))
            else:
                curved.append(leaf)
        if not followers:
            raise Unfollowed(f"no number follows {name!r} of {label!r}")
        return followers, curved


def _flat(part: Part, name: str, prefix: str = "") -> Iterator[tuple[LeafPath, Any]]:
    """Yield the values of a part and of its nested parts, by their paths."""
    for p in parameters(type(part)):
        if not prefix and p.name in STRUCTURE:
            continue
        yield from _inside(getattr(part, p.name), name, prefix + p.name)


def _inside(value: Any, name: str, path: str) -> Iterator[tuple[LeafPath, Any]]:
    if isinstance(value, Part):
        yield from _flat(value, name, f"{path}.")
    elif isinstance(value, tuple) and value and all(isinstance(v, Part) for v in cast(Any, value)):
        for k, inner in enumerate(cast("tuple[Any, ...]", value)):
            yield from _inside(inner, name, f"{path}.{k}")
    else:
        yield (name, path), value


def _entries(leaf: LeafPath, *values: Any) -> Iterator[tuple[Any, ...]]:
    """Yield values that belong together; tuples of one length entry by entry."""
    if all(isinstance(v, tuple) for v in values) and len({len(v) for v in values}) == 1:
        for k, inner in enumerate(zip(*values, strict=True)):
            yield ((leaf[0], f"{leaf[1]}.{k}"), *inner)
    else:
        yield (leaf, *values)


def aligned(
    present: Mapping[LeafPath, Any], others: Sequence[Mapping[LeafPath, Any]]
) -> tuple[dict[LeafPath, Any], list[dict[LeafPath, Any]]]:
    """Return values at present and several others by the same leaves: tuples of one length entry by entry.

    A value that one of the others lacks is the present one.
    """
    base: dict[LeafPath, Any] = {}
    rows: list[dict[LeafPath, Any]] = [{} for _ in others]
    for leaf, value in present.items():
        for inner, first, *new_values in _entries(leaf, value, *(o.get(leaf, value) for o in others)):
            base[inner] = first
            for leaves, new in zip(rows, new_values, strict=True):
                leaves[inner] = new
    return base, rows
