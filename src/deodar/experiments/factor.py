"""A factor: parameters in which trials of an experiment differ, and the assignment of levels to trials."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, cast

import numpy as np

from deodar.parameters import Part, Recompile, real, show

DESIGNS = ("crossed", "shuffled", "random")

Label = str | float
"""Label of a level in rows: its value if it is one number or text, else its name."""


@dataclass(frozen=True)
class Factor(Part):
    """Parameters in which trials differ, and their levels.

    Attributes:
        name: name of the factor in rows.
        levels: a list of values of one parameter, or for each level its name and the values of parameters:
            {"near": {"left.center": 45}}.
        path: the parameter, of an element or of the document, whose values the levels are; empty where levels
            name parameters themselves.
    """

    name: str
    levels: object
    path: Annotated[str, Recompile(names="parameter")] = ""

    def validate(self) -> Iterator[tuple[str, str]]:
        levels: Any = self.levels
        if isinstance(levels, (str, bytes)) or not isinstance(levels, (Mapping, Sequence, np.ndarray)):
            yield "levels", f"needs a list of values, or an object of named levels, not {show(levels)}"
            return
        if len(levels) == 0:
            yield "levels", "holds no levels, so there is nothing to run"
            return
        if not self.path and any(not isinstance(v, Mapping) or not v for v in self._values):
            problem = (
                'needs for each level the parameters it sets, {"left.amplitude": 6}, because no path is given'
            )
            yield "levels", problem
        elif not self.path and not isinstance(levels, Mapping):
            yield "levels", 'needs a name for each level: {"near": {"left.center": 45}}'
        labels = self.labels
        if len(set(labels)) < len(labels):
            yield "levels", f"holds the level {next(v for v in labels if labels.count(v) > 1)!r} twice"

    @property
    def labels(self) -> list[Label]:
        """The label of each level in rows."""
        levels: Any = self.levels
        if isinstance(levels, Mapping):
            return list(cast("Mapping[str, Any]", levels))
        return [v if isinstance(v, str) else f if (f := real(v)) is not None else str(v) for v in levels]

    @property
    def sets(self) -> list[dict[str, Any]]:
        """For each level, the parameters it sets."""
        return [{self.path: v} if self.path else dict(v) for v in self._values]

    @property
    def _values(self) -> list[Any]:
        levels: Any = self.levels
        return list(levels.values() if isinstance(levels, Mapping) else levels)


def assign(factors: Sequence[Factor], design: str, trials: int, seed: int) -> list[tuple[int, ...]]:
    """Return for each trial the level (its number) of each factor.

    Args:
        factors: parameters in which trials differ.
        design: `crossed`: `trials` of each combination, one combination after another; `shuffled`: the same
            in an order drawn from the seed; `random`: `trials` in total, each with levels drawn from the
            seed.
        trials: number of trials, per combination or in total.
        seed: seed of the order and the draws.
    """
    counts = [len(f.labels) for f in factors]
    draw = np.random.default_rng(seed)
    if design == "random":
        return [tuple(row) for row in draw.integers(0, counts, size=(trials, len(counts))).tolist()]
    rows = [cell for cell in itertools.product(*map(range, counts)) for _ in range(trials)]
    return [rows[k] for k in draw.permutation(len(rows))] if design == "shuffled" else rows
