"""A branch of steady states over one parameter, with its bifurcations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.analysis.continuation import walk
from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.naming import named
from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.analysis.continuation.walk import Walk, growing, with_step_values
from deodar.analysis.saved import SavedAnalysis
from deodar.codec import JsonObject
from deodar.errors import AnalysisError
from deodar.numerics.axes import Axis
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    import xarray


STATE, BIFURCATION = "state", "bifurcation"
"""Dimensions of a record: steady states, and bifurcations."""

STATED = (
    *("kind", "instability", "where", "value", "rate", "frequency", "index"),
    *("step_value", "fine_value", "by_grid"),
)
"""What a record states of a bifurcation, beside its arrays."""


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

    KIND = "steady_branch"
    PHRASE = "a branch of steady states"

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
        branches = [branch(self.parameter, walked) for walked in walk.switched(at, limits, points)]
        if not branches:
            raise AnalysisError(f"no other branch was found at {at!r}")
        return branches

    def dataset(self) -> xarray.Dataset:
        """Return the branch as a Dataset, with the document, its arguments and the versions that made it.

        The arrays of states are variables by path, such as `u.activation`; those at bifurcations and the
        modes there are `bifurcation:u.activation` and `mode:u.activation`.
        """
        # start-up time: these bring xarray
        import xarray

        from deodar.analysis.continuation import line_file
        from deodar.recording.provenance import KEY

        equations = self.line.right_hand_side
        taken: dict[str, Axis | None] = {STATE: None, BIFURCATION: None}
        variables: dict[str, Any] = {
            "rate": (STATE, self.rates, {"long_name": "largest growth rate"}),
            "growing": (STATE, self.growing.astype(np.int64), {"long_name": "growing modes"}),
        }
        dims = {f"{p.path}.{p.name}": _dims(p.path, p.name, p.shape, p.axes, taken) for p in equations.parts}
        for prefix, lead, rows in (
            ("", STATE, self.states),
            ("bifurcation:", BIFURCATION, [b.state for b in self.bifurcations]),
            ("mode:", BIFURCATION, [b.vector for b in self.bifurcations]),
        ):
            for path, arrays in _by_path(equations, rows).items():
                variables[prefix + path] = ((lead, *dims[path]), arrays)
        coordinates: dict[str, Any] = {
            dim: (dim, axis.points, {"units": axis.unit} if axis.unit else {})
            for dim, axis in taken.items()
            if axis is not None
        }
        over = {"long_name": self.parameter}
        coordinates["value"] = (STATE, self.values, over)
        coordinates[BIFURCATION] = (BIFURCATION, [b.value for b in self.bifurcations], over)
        description = {
            "parameter": self.parameter,
            "ended": list(self.ended),
            "not_refined": self.not_refined,
            "bifurcations": [{name: getattr(b, name) for name in STATED} for b in self.bifurcations],
        }
        made_by = codec.line({**line_file.made(self.line), self.KIND: description})
        return xarray.Dataset(variables, coordinates, {KEY: made_by, "title": equations.doc.name})

    @classmethod
    def of_record(cls, record: xarray.Dataset, provenance: Mapping[str, Any]) -> SteadyBranch:
        # start-up time: this brings xarray
        from deodar.analysis.continuation import line_file

        line, description = line_file.line_of(provenance), provenance[cls.KIND]
        if line is None:
            raise ValueError("it states no line of parameters")
        states, places, modes = (
            _rows(line.right_hand_side, record, prefix) for prefix in ("", "bifurcation:", "mode:")
        )
        return cls(
            description["parameter"],
            record["value"].values,
            states,
            record["rate"].values,
            record["growing"].values,
            tuple(
                Bifurcation(state=x, vector=v, line=line, **b)
                for b, x, v in zip(description["bifurcations"], places, modes, strict=True)
            ),
            (description["ended"][0], description["ended"][1]),
            line,
            description["not_refined"],
        )

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


def _dims(
    path: str, name: str, shape: Sequence[int], axes: Sequence[Axis], taken: dict[str, Axis | None]
) -> tuple[str, ...]:
    """Return the dimensions of an array, named by axes; others that have a name already are named by path."""
    out: list[str] = []
    for d, axis in enumerate(axes or [None] * len(shape)):
        dim = f"{path}.{name}.{d}" if axis is None else axis.name
        if dim in out or (dim in taken and taken[dim] != axis):
            dim = f"{path}.{name}.{dim}"
        taken[dim] = axis
        out.append(dim)
    return tuple(out)


def _by_path(equations: RightHandSide, rows: Sequence[np.ndarray] | np.ndarray) -> Mapping[str, np.ndarray]:
    """Return states by path, states first."""
    states = [equations.state(x) for x in rows]
    return {
        f"{p.path}.{p.name}": np.array([s[f"{p.path}.{p.name}"] for s in states]).reshape(-1, *p.shape)
        for p in equations.parts
    }


def _rows(equations: RightHandSide, record: xarray.Dataset, prefix: str) -> np.ndarray:
    """Return states by path as rows."""
    arrays = {(path := f"{p.path}.{p.name}"): record[prefix + path].values for p in equations.parts}
    number = len(record["value"] if not prefix else record[BIFURCATION])
    return np.array([equations.vector({k: a[n] for k, a in arrays.items()}) for n in range(number)]).reshape(
        number, equations.size
    )
