"""A branch of steady states over one parameter, with its bifurcations."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.continuation import switching
from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.naming import named
from deodar.analysis.continuation.walk import Walk, growing, with_step_values
from deodar.analysis.saved import SavedAnalysis
from deodar.codec import JsonObject
from deodar.errors import AnalysisError
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class SteadyBranch(Summarised, SavedAnalysis):
    """Steady states of a model, stable or not, in the order in which they were found.

    Attributes:
        parameter: path of the parameter.
        values: its value at each state.
        states: the states x, one row each; `read` and `state` give their parts.
        rates: the growth rate of the fastest mode of each, per document time; below 0: stable.
        growing: the number of growing modes of each.
        bifurcations: what lies between them.
        ended: why each end is one: `span`, `closed`, `points` or `lost`; the start first.
        line: the model along its parameter.
        not_refined: why it was not followed on a grid twice as fine; empty if it was, or was not to be.
    """

    parameter: str
    values: np.ndarray
    states: np.ndarray
    rates: np.ndarray
    growing: np.ndarray
    bifurcations: tuple[Bifurcation, ...]
    ended: tuple[str, str]
    line: ParameterLine = field(repr=False)
    not_refined: str = ""

    @property
    def stable(self) -> np.ndarray:
        """Whether each state is stable; a neutral mode does not count."""
        return self.growing == 0

    def read(self, path: str) -> np.ndarray:
        """Return a port in every state, such as `u.activation`; states first."""
        line = self.line
        points = [line.point(x, value) for x, value in zip(self.states, self.values, strict=True)]
        return np.stack(
            [line.right_hand_side.read(path, line.state(z), line.all_parameters(z)) for z in points]
        )

    def state(self, number: int) -> dict[str, np.ndarray]:
        """Return the arrays of one state by element and name, such as `u.activation`."""
        return self.line.right_hand_side.state(self.states[number])

    def switch(
        self, at: Bifurcation, span: tuple[float, float] | None = None, points: int = 400
    ) -> list[SteadyBranch]:
        """Return the branches that leave a branch point, in both directions of its mode.

        Args:
            at: a branch point of this branch.
            span: values of the parameter; None: those of this branch.
            points: largest number of states of each.

        Raises:
            AnalysisError: it is not a branch point, or no other branch was found there.
        """
        if at.kind != "branch point":
            raise AnalysisError(f"no branch leaves a {at.kind}", fix="Give one of the branch points")
        limits = span or (float(self.values.min()), float(self.values.max()))
        branches = [branch(self.parameter, walked) for walked in switching.switched(at, limits, points)]
        if not branches:
            raise AnalysisError(f"no other branch was found at {at!r}")
        return branches

    def dataset(self) -> xarray.Dataset:
        """Return the branch as a Dataset, with the document, its arguments and the versions that made it."""
        # start-up time: this brings xarray
        from deodar.analysis.continuation import branch_file

        numbers = {"value": self.values, "rate": self.rates, "growing": self.growing}
        description = {
            "parameter": self.parameter,
            "ended": list(self.ended),
            "not_refined": self.not_refined,
        }
        return branch_file.dataset(self.line, numbers, self.states, self.bifurcations, description)

    @classmethod
    def load(cls, path: str | Path) -> SteadyBranch:
        """Read a branch that `save` wrote.

        The model is that of the document in the file, so that the branch can be left at a branch point, its
        ports can be read, and its folds have sensitivities.

        Args:
            path: the file.

        Raises:
            RecordError: the file does not exist, is damaged, or is another record.
        """
        # start-up time: this brings xarray
        from deodar.analysis.continuation import branch_file

        return cls(**branch_file.fields(path))

    def data(self) -> JsonObject:
        """Return what was found as plain data, without the states."""
        return {
            "parameter": self.parameter,
            "from": float(self.values[0]),
            "to": float(self.values[-1]),
            "states": len(self.values),
            "stable": int(self.stable.sum()),
            "ended": list(self.ended),
            "bifurcations": [found.data() for found in self.bifurcations],
        }

    def _summary(self) -> Summary:
        low, high = self.values.min(), self.values.max()
        span = f"from {low:.4g} to {high:.4g}"
        rows = [(b.kind, b.instability, f"{b.value:.6g}") for b in self.bifurcations]
        return Summary(f"{len(self.values)} steady states over {self.parameter} {span}", rows)


def branch(parameter: str, walked: tuple[ParameterLine, Walk], begin: str = "start") -> SteadyBranch:
    """Return a walk as a branch, its bifurcations with their names."""
    line, walk = walked
    rates = np.array([float(p.rates.real.max(initial=-np.inf)) for p in walk.points])
    modes = np.array([growing(line, p) for p in walk.points])
    bifurcations: list[Bifurcation] = []
    for b in with_step_values(line, walk):
        # a state that is unstable on both sides is never seen
        seen = min(modes[b.index], modes[b.index + 1]) == 0
        bifurcations.append(named(b, walk.points) if seen else b)
    return SteadyBranch(
        parameter,
        np.array([line.value(p.z) for p in walk.points]),
        np.array([line.state(p.z) for p in walk.points]),
        rates,
        modes,
        tuple(bifurcations),
        (begin, walk.ended),
        line,
    )
