"""The points of a sweep."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from deodar.batch.driven import driven
from deodar.compiler.plan import Leaf, cost
from deodar.errors import ParameterError
from deodar.leaves import leaves
from deodar.model import edit
from deodar.model.document import Document
from deodar.parameters import real, show


class Points:
    """The grid of a sweep: the leaves that each entry drives, and its value at every point."""

    def __init__(self, doc: Document, sweep: Mapping[str, Sequence[float]]) -> None:
        self.doc = doc
        self.paths = list(sweep)
        self.leaves: list[list[Leaf]] = []
        lists: list[list[float]] = []
        for path, values in sweep.items():
            given = [] if isinstance(values, (str, bytes)) or not np.iterable(values) else list(values)
            found = [number for number in map(real, given) if number is not None]
            if not given or len(found) < len(given):
                raise ParameterError(f"needs a list of numbers, not {show(values)}", where=f"sweep of {path}")
            self.leaves.append(driven(doc, path))
            _require_on(doc, path, self.leaves[-1], values)
            lists.append(found)
        self.lists = lists
        self.size = math.prod(len(v) for v in lists)

    @property
    def values(self) -> list[np.ndarray]:
        """Return for each entry its value at every point; computed after the check that they fit into
        memory.
        """
        return [grid.ravel() for grid in np.meshgrid(*(np.array(v) for v in self.lists), indexing="ij")]

    def place(self, copy: tuple[int, ...], trials: bool) -> tuple[int, ...]:
        """Return the index of a copy along the entries of the sweep, and along the trials if it has any."""
        point = np.unravel_index(copy[0], [len(v) for v in self.lists]) if self.lists else ()
        return (*(int(k) for k in point), *copy[len(copy) - trials :])

    @property
    def by_path(self) -> dict[str, list[float]]:
        """For each path its values."""
        return dict(zip(self.paths, self.lists, strict=True))

    def documents(self) -> Iterator[Document]:
        """Yield the document at each value of each entry (not at each point): values are checked one by
        one.
        """
        for path, values in zip(self.paths, self.lists, strict=True):
            for value in values:
                yield edit.change(self.doc, path, value)

    def rebuilt(self) -> set[str]:
        """Return the ids of the elements whose constants differ from point to point."""
        by = self.doc.by_id()
        costs = {
            (i, path): cost(p)
            for i in {i for found in self.leaves for i, _ in found}
            for path, _, p in leaves(by[i].element)
        }
        return {i for found in self.leaves for i, path in found if costs[i, path] == "rebuild"}


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
