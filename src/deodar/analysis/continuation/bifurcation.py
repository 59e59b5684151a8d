"""A point of a branch at which steady states appear, vanish, branch, or begin to oscillate."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from deodar.analysis.continuation.line import DENSE, ParameterLine, leading
from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.codec import JsonObject
from deodar.errors import AnalysisError
from deodar.leaves import leaves
from deodar.model.document import Leaf
from deodar.summary import Summarised, Summary

BifurcationKind = Literal["fold", "branch point", "Hopf"]


@dataclass(frozen=True, repr=False)
class Bifurcation(Summarised):
    """A bifurcation of steady states.

    Attributes:
        kind: `fold` (two steady states meet and vanish), `branch point` (branches cross), or `Hopf` (a steady
            state begins to oscillate).
        value: value of the parameter, from the equation.
        state: the steady state x.
        vector: the direction in which the state grows or decays slowest there; of unit length.
        rate: growth rate that crosses 0, per document time: 0 up to the accuracy of `value`.
        frequency: angular frequency of a Hopf point, per document time; else 0.
        index: the last point of the branch before it.
        line: the model along its parameter.
        instability: name in Dynamic Field Theory, such as `detection`; empty where no peak appears, vanishes
            or loses against another one.
        where: path of the field in which peaks change.
        step_value: value at which the Euler step with the document's dt begins to oscillate; None: it does
            not in this branch, or it is no Hopf point.
        fine_value: value on a grid twice as fine; None: not measured, or not there.
        by_grid: whether a grid twice as fine has no such bifurcation; None: not measured.
    """

    kind: BifurcationKind
    value: float
    state: np.ndarray
    vector: np.ndarray
    rate: float
    frequency: float
    index: int
    line: ParameterLine = field(repr=False)
    instability: str = ""
    where: str = ""
    step_value: float | None = None
    fine_value: float | None = None
    by_grid: bool | None = None

    def __repr__(self) -> str:
        name = f"({self.instability})" if self.instability else ""
        return f"{self.kind}{name} {self.value:.6g}"

    @property
    def words(self) -> str:
        """The bifurcation in words."""
        period = 2 * np.pi / (self.frequency or 1)
        name = {
            "fold": "fold: two steady states meet and vanish",
            "branch point": "branch point: branches of steady states cross",
            "Hopf": f"Hopf point: oscillations with a period of {period:.4g} begin",
        }[self.kind]
        if self.instability:
            name = f"{self.instability} of {self.where} ({name})"
        if self.by_grid:
            name += "; made by the grid: a grid twice as fine does not have it"
        return name

    @property
    def state_by_path(self) -> dict[str, np.ndarray]:
        """The steady state by element and array, such as `u.activation`."""
        return self.line.right_hand_side.state(self.state)

    @cached_property
    def sensitivity(self) -> dict[str, float]:
        """The derivative of the value of a fold in each other number of the model.

        With the left null vector w of the derivative of F in the state, dp/dq = -(w F_q) / (w F_p).

        Raises:
            AnalysisError: it is not a fold; w F_p is then 0.
        """
        if self.kind != "fold":
            raise AnalysisError(f"a {self.kind} has no sensitivity", fix="Ask a fold")
        equations = self.line.right_hand_side
        paths = [path for path in live_numbers(equations) if path != equations.parameters[self.line.index]]
        wide = RightHandSide(
            equations.model,
            equations.doc,
            [equations.parameters[self.line.index], *paths],
            equations.at,
            equations.held,
            equations.even,
        )
        values = wide.values.copy()
        values[0] = self.value
        null_vector = _left_null_vector(self.line, self.state, self.value)
        slopes = wide.gradient(self.state, values, null_vector)
        return {path: float(-slopes[k + 1] / slopes[0]) for k, path in enumerate(paths)}

    def data(self) -> JsonObject:
        """Return what it is as plain data, without its state."""
        return {
            "kind": self.kind,
            "value": self.value,
            "instability": self.instability or None,
            "field": self.where or None,
            "rate": self.rate,
            "frequency": self.frequency or None,
            "euler_value": self.step_value,
            "value_on_a_finer_grid": self.fine_value,
            "made_by_the_grid": self.by_grid,
            "words": self.words,
        }

    def _summary(self) -> Summary:
        return Summary(self.words, [("value of the parameter", self.value)])


def live_numbers(of: RightHandSide) -> list[str]:
    """Return the paths of all numbers on which the steady states of a model may depend."""
    linked: set[Leaf] = {(link[0], link[1]) for shared in of.doc.parameters for link in shared.links}
    paths = [shared.name for shared in of.doc.parameters if shared.links]
    for entry in of.doc.entries:
        for leaf, _, parameter in leaves(entry.element):
            if parameter.form != "array" and (entry.id, leaf) not in linked and _counts(leaf):
                paths.append(f"{entry.path}.{leaf}")
    return paths


def _counts(leaf: str) -> bool:
    """Return whether steady states may depend on a number."""
    return leaf not in ("tau", "noise", "noise_length")


def _left_null_vector(line: ParameterLine, x: np.ndarray, value: float) -> np.ndarray:
    """Return the left null vector of the derivative in the state."""
    equations, parameters = line.right_hand_side, line.all_parameters(line.point(x, value))
    if equations.size <= DENSE:
        return np.linalg.svd(equations.linear(x, parameters)[1])[0][:, -1]
    tau = equations.time_constants
    rates, vectors = leading(equations.size, lambda w: equations.back(x, parameters, w / tau))
    return np.real(vectors[:, np.argmin(np.abs(rates))]) / tau
