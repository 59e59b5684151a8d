"""The layout of parameters: the index of each number of a document in the arguments of its program."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar.compiler.arguments import EitherArray, ProgramValues
from deodar.compiler.plan import Plan, RowGroup
from deodar.compiler.program import array_key
from deodar.errors import ParameterError
from deodar.leaves import leaves
from deodar.model.document import Document, Leaf
from deodar.numerics.exact import LOW, split


class LeafLayout:
    """Places of the leaves of a plan.

    Attributes:
        swept: for each swept leaf its places in the parameter vector; at the end those of the digits that
            rounding takes from exact leaves.
    """

    def __init__(self, plan: Plan, precision: str, sweep: Sequence[Sequence[Leaf]]) -> None:
        self.plan, self.precision, self.dtype = plan, precision, np.dtype(precision)
        lows = [[(i, path + LOW) for i, path in leafs if path in self._group(i).exact] for leafs in sweep]
        self._rounded = [k for k, low in enumerate(lows) if low]
        self.swept = [
            [self.place(leaf) for leaf in leafs] for leafs in [*sweep, *(lows[k] for k in self._rounded)]
        ]

    def place(self, leaf: Leaf) -> int:
        """Return the index of a scalar leaf in the parameter vector."""
        ident, path = leaf
        g, r = self.plan.row[ident]
        return self.plan.groups[g].offset[path] + r

    def values(self, doc: Document, points: int, swept: Sequence[np.ndarray] | None = None) -> ProgramValues:
        """The parameters of a document of this structure, on the host; `swept`: the values of each entry of
        the sweep at its points.
        """
        vector = np.zeros(self.plan.size, self.dtype)
        arrays: dict[str, EitherArray] = {}
        by = doc.by_id()
        for g, group in enumerate(self.plan.groups):
            columns = [
                {path: value for path, value, _ in leaves(by[n.id].element if n.declared else n.element)}
                for n in group.nodes
            ]
            for name, offset in group.offset.items():
                path = name.removesuffix(LOW)
                for n, c in zip(group.nodes, columns, strict=True):
                    require_range(doc, (n.id, path), c[path], self.precision)
                vector[offset : offset + group.rows] = self._part(name, [c[path] for c in columns])
            for name in group.arrays:
                arrays[array_key(g, name)] = np.stack(
                    [self._part(name, c[name.removesuffix(LOW)]) for c in columns]
                )
        points_of_sweep = self.points(swept) if swept is not None else None
        if points_of_sweep is None:
            points_of_sweep = tuple(
                np.full(points, vector[places[0]] if places else 0, self.dtype) for places in self.swept
            )
        return {"vector": vector, "arrays": arrays, "swept": points_of_sweep}

    def points(self, swept: Sequence[np.ndarray]) -> tuple[np.ndarray, ...]:
        """Return the values of each entry of the sweep at its points as arguments of the program."""
        rows = [*swept, *(split(swept[k], self.dtype)[1] for k in self._rounded)]
        return tuple(np.asarray(values, self.dtype) for values in rows)

    def put(self, vector: np.ndarray, leaf: Leaf, value: float) -> None:
        """Write the value of a scalar leaf into the parameter vector."""
        high, low = split(value, self.dtype)
        vector[self.place(leaf)] = high
        if leaf[1] in self._group(leaf[0]).exact:
            vector[self.place((leaf[0], leaf[1] + LOW))] = low

    def put_array(self, arrays: dict[str, np.ndarray], leaf: Leaf, value: np.ndarray) -> None:
        """Write an array leaf into the arrays, in copies of those that change."""
        g, r = self.plan.row[leaf[0]]
        names = (leaf[1], leaf[1] + LOW) if leaf[1] in self._group(leaf[0]).exact else (leaf[1],)
        for name, part in zip(names, split(value, self.dtype), strict=False):
            rows = arrays[array_key(g, name)].copy()
            rows[r] = part
            arrays[array_key(g, name)] = rows

    def _group(self, ident: str) -> RowGroup:
        return self.plan.groups[self.plan.row[ident][0]]

    def _part(self, name: str, value: float | np.ndarray | Sequence[float | np.ndarray]) -> np.ndarray:
        """Return a leaf in the working precision, or its rounding error."""
        return split(value, self.dtype)[name.endswith(LOW)]


def require_range(doc: Document, leaf: Leaf, value: float | np.ndarray, precision: str) -> None:
    """Raise an error if a number exceeds the range of the working precision."""
    if abs(value) > float(np.finfo(precision).max):
        entry = doc.by_id().get(leaf[0])
        raise ParameterError(
            f"is {value:g}, beyond what {precision} can hold",
            where=f"{entry.path if entry else leaf[0]}.{leaf[1]}",
            fix="Use precision='float64'",
        )
