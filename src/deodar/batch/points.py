"""The points of a sweep: a grid, or a list."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from deodar.compiler.build import cost
from deodar.compiler.driven import driven
from deodar.errors import ParameterError
from deodar.leaves import leaves
from deodar.model import edit
from deodar.model.document import Document, Leaf
from deodar.parameters import real, show
from deodar.sweep import POINT, Points, Sweep, checked


class SweepPoints:
    """The points of a sweep: the leaves that each entry drives, and its value at every point.

    Args:
        doc: the document.
        sweep: the values.
        first: number of the first point of a list, in a piece of a run.

    Attributes:
        paths: the parameter paths.
        leaves: for each path the numbers that it drives.
        listed: whether the points are a list.
        own_noise: whether each point has noise of its own.
        size: number of points.
        grid: the dimensions of the points, with the values of their coordinates.
        beside: for each path of a list its value at each point; empty for a grid.
    """

    def __init__(self, doc: Document, sweep: Sweep | None, first: int = 0) -> None:
        self.doc = doc
        points = checked(sweep)
        self.listed = isinstance(points, Points)
        self.own_noise = isinstance(points, Points) and points.own_noise
        by_path = points.by_path() if isinstance(points, Points) else points
        self.paths = list(by_path)
        self.leaves: list[list[Leaf]] = []
        lists: list[list[float]] = []
        for path, values in by_path.items():
            entries = [] if isinstance(values, (str, bytes)) or not np.iterable(values) else list(values)
            reals = [number for number in map(real, entries) if number is not None]
            if not entries or len(reals) < len(entries):
                raise ParameterError(f"needs a list of numbers, not {show(values)}", where=f"sweep of {path}")
            self.leaves.append(driven(doc, path))
            _require_on(doc, path, self.leaves[-1], values)
            lists.append(reals)
        self.lists = lists
        columns = dict(zip(self.paths, lists, strict=True))
        numbers = range(first, first + len(lists[0])) if lists else range(0)
        self.grid: dict[str, Sequence[float]] = {POINT: numbers} if self.listed else {**columns}
        self.beside: dict[str, list[float]] = columns if self.listed else {}
        self.size = math.prod(len(values) for values in self.grid.values())

    @property
    def values(self) -> list[np.ndarray]:
        """Return for each entry its value at every point; computed after the check that they fit into
        memory.
        """
        if self.listed:
            return [np.array(values) for values in self.lists]
        return [grid.ravel() for grid in np.meshgrid(*(np.array(v) for v in self.lists), indexing="ij")]

    def place(self, copy: tuple[int, ...], trials: bool) -> tuple[int, ...]:
        """Return the index of a copy along the dimensions of the points, and of the trials if it has any."""
        point = np.unravel_index(copy[0], [len(v) for v in self.grid.values()]) if self.grid else ()
        return (*(int(k) for k in point), *copy[len(copy) - trials :])

    @property
    def asked(self) -> dict[str, list[float]] | list[dict[str, float]]:
        """The sweep as plain data."""
        if self.listed:
            return [dict(zip(self.paths, point, strict=True)) for point in zip(*self.lists, strict=True)]
        return dict(zip(self.paths, self.lists, strict=True))

    def documents(self) -> Iterator[Document]:
        """Yield the documents whose values are to be checked: each point of a list; of a grid each value of
        each entry, one by one.
        """
        if self.listed:
            for point in zip(*self.lists, strict=True):
                doc = self.doc
                for path, value in zip(self.paths, point, strict=True):
                    doc = edit.change(doc, path, value)
                yield doc
            return
        for path, values in zip(self.paths, self.lists, strict=True):
            for value in values:
                yield edit.change(self.doc, path, value)

    def rebuilt(self) -> set[str]:
        """Return the ids of the elements whose constants differ from point to point."""
        by = self.doc.by_id()
        costs = {
            (i, path): cost(p)
            for i in {i for leafs in self.leaves for i, _ in leafs}
            for path, _, p in leaves(by[i].element)
        }
        return {i for leafs in self.leaves for i, path in leafs if costs[i, path] == "rebuild"}


def dimensions(sweep: Any) -> list[str]:
    """Return the dimensions of the points of a sweep as plain data; none without a sweep."""
    return list(sweep or ()) if isinstance(sweep or {}, Mapping) else [POINT]


def _require_on(doc: Document, path: str, driven: Sequence[Leaf], values: Sequence[float]) -> None:
    """Refuse values that switch a term off among values that do not: they need different programs."""
    by = doc.by_id()
    for ident, inner in driven:
        declared = {leaf: p for leaf, _, p in leaves(by[ident].element)}[inner]
        if declared.off and any(v == declared.neutral for v in values):
            raise ParameterError(
                f"the value {declared.neutral:g} switches it off, which is another program and not the limit"
                " of small values",
                where=f"sweep of {path}",
                fix="Run that value separately",
            )
