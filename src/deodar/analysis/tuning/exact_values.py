"""Stated values reached exactly: Newton's method on folds and steady states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import DENSE, ParameterLine, solved
from deodar.analysis.continuation.naming import named
from deodar.analysis.continuation.right_hand_side import RightHandSide, right_hand_side
from deodar.analysis.continuation.walk import begun, growing, walk
from deodar.analysis.tuning.request import TuningRequest
from deodar.analysis.tuning.requirement import ExactQuantity
from deodar.errors import AnalysisError, DeodarError

ACCURACY = 1e-9
"""Largest error of a reached value, in units of its tolerance."""

MOST = 12
"""Steps of Newton's method."""

LARGEST = 0.1
"""Largest relative change of a parameter in one step."""

SETTLING = 300.0
"""Time constants for which the field settles before Newton's method begins."""

STATES = 400
"""Most states of a branch on which a fold is looked for."""

MIDDLE, BOOST = 0, 3
"""Numbers of the inputs that are varied, among the parameters of the equations."""


@dataclass(frozen=True)
class ExactValue:
    """A quantity and its derivative.

    Attributes:
        value: its value.
        slopes: its derivative in each parameter.
        state: the steady state at which it was found.
    """

    value: float
    slopes: np.ndarray
    state: np.ndarray


class QuantityLost(Exception):
    """Raised inside the search where a quantity does not exist."""


class ExactField:
    """The equations of the tuned field.

    Args:
        request: what is tuned.

    Attributes:
        why: why the equations are not used; empty if they are.
    """

    def __init__(self, request: TuningRequest) -> None:
        self._request = request
        self.why = ""
        axes, center = request.isolated.axes, request.isolated.center
        middle = all(
            abs(c - float(axis.points[[0, -1]].mean())) < 1e-6 * axis.range
            for c, axis in zip(center, axes, strict=True)
        )
        # a peak without input may stand anywhere: it stays in the middle
        even = [axis.name for axis in axes] if middle and not request.isolated.background else []
        inputs = [f"{name}.amplitude" for name in ("middle", "first", "second", "boost")]
        try:
            self.right_hand_side: RightHandSide = right_hand_side(
                request.model, [*inputs, *request.names], even=even
            )
        except DeodarError as error:
            self.why = error.problems[0].what
            return
        if self.right_hand_side.size > DENSE:
            self.why = f"the field has {self.right_hand_side.size} states, more than {DENSE}"

    # --------------------------------------------------------------------------------------------- quantities

    def value(self, of: ExactQuantity, values: np.ndarray, near: ExactValue | None = None) -> ExactValue:
        """Return a quantity at values of the parameters.

        Args:
            of: the quantity.
            values: values of the tuned parameters.
            near: the quantity at near values, from which a fold is followed.

        Raises:
            QuantityLost: it does not exist there, or was not found.
        """
        if of.of_peak:
            return self._form(of, values)
        over = BOOST if of.kind == "forgetting" else MIDDLE
        if near is not None:
            return self._fold(near.state, near.value, over, values)
        fold = self._first_fold(of, over, values)
        return self._fold(fold.state, fold.value, over, values)

    def _first_fold(self, of: ExactQuantity, over: int, values: np.ndarray) -> Bifurcation:
        """Return the first fold of the kind over an input: from rest upwards, or downwards from a peak
        without input. Up to there the field keeps its state.
        """
        equations, parameters = self.right_hand_side, self._all(values)
        reach = self._request.isolated.scale
        if of.kind == "forgetting":
            parameters[MIDDLE], parameters[BOOST] = of.strength, of.target + of.within
            first, last = of.target + of.within, of.target - 2 * of.within - 0.1 * reach
        else:
            first, last = 0.0, max(2 * of.target, of.strength, reach)
        x = equations.settle(equations.start, parameters, SETTLING)
        parameters_at_start = parameters.copy()
        parameters_at_start[MIDDLE] = 0.0
        parameters_at_start[over] = first
        x = equations.settle(x, parameters_at_start, SETTLING)
        line = ParameterLine(equations, over, parameters_at_start, max(abs(last - first) / 10, 1e-6))
        start = begun(line, x, first, float(np.sign(last - first)))
        if start is None:
            raise QuantityLost
        low, high = min(first, last), max(first, last)
        if of.kind == "reverse detection":
            low = min(low, of.target - 2 * of.within - 0.1 * reach)
        walked = walk(line, start, (low, high), STATES)
        for fold in walked.bifurcations:
            sides = walked.points[fold.index : fold.index + 2]
            # a state that is unstable on both sides is never seen
            seen = fold.kind == "fold" and min(growing(line, point) for point in sides) == 0
            if seen and named(fold, walked.points).instability == of.kind:
                return fold
        raise QuantityLost

    def _fold(self, x: np.ndarray, at: float, over: int, values: np.ndarray) -> ExactValue:
        """Return a fold near a state, as the root of the minimally augmented equations (see `locus`)."""
        equations, p, n = self.right_hand_side, self._all(values), x.size
        p[over] = at
        left, _, right = np.linalg.svd(equations.linear(x, p)[1])
        border_left, border_right = left[:, -1], right[-1]
        for _ in range(MOST):
            rates, jacobian, by = equations.linear(x, p)
            bordered = np.zeros((n + 1, n + 1))
            bordered[:n, :n], bordered[:n, n], bordered[n, :n] = jacobian, border_left, border_right
            unit = np.append(np.zeros(n), 1.0)
            v, w = solved(bordered, unit), solved(bordered.T, unit)
            residual = np.append(rates, v[n])
            if np.abs(residual).max() < 1e-11:
                slopes = equations.gradient(x, p, w[:n])
                return ExactValue(float(p[over]), -slopes[len(p) - len(values) :] / slopes[over], x)
            by_state, by_parameter = equations.curvature(x, p, v[:n], w[:n])
            rows = np.vstack(
                [np.column_stack([jacobian, by[:, over]]), np.append(-by_state, -by_parameter[over])]
            )
            move = solved(rows, -residual)
            if not np.isfinite(move).all() or np.abs(move[:n]).max() > self._request.isolated.scale:
                break
            x, p[over] = x + move[:n], p[over] + move[n]
        raise QuantityLost

    def _form(self, of: ExactQuantity, values: np.ndarray) -> ExactValue:
        """Return the width or amplitude of the peak of an input."""
        equations, p = self.right_hand_side, self._all(values)
        x = equations.settle(equations.start, p, SETTLING)
        p[MIDDLE] = of.strength
        x = equations.settle(x, p, SETTLING)
        line = ParameterLine(equations, MIDDLE, p, 1.0)
        start = begun(line, x, of.strength, 1.0)
        if start is None:
            raise QuantityLost
        x = line.state(start.z)
        activation = equations.state(x)["field.activation"].ravel()
        number = self._request.threshold_of
        threshold = self._request.isolated.threshold if number is None else float(values[number])
        axes = self._request.isolated.axes
        if of.kind == "width":
            size, slope = _width(activation - threshold, axes[0].step, axes[0].periodic)
            by_threshold = -float(slope.sum())
        else:
            highest = int(activation.argmax())
            size, by_threshold = float(activation[highest]), 0.0
            slope = np.eye(1, activation.size, highest)[0]
        _, jacobian, by = equations.linear(x, p)
        along = equations.vector({"field.activation": slope.reshape(equations.parts[0].shape)})
        slopes = -(solved(jacobian.T, along) @ by)[len(p) - len(values) :]
        if number is not None:
            slopes[number] += by_threshold
        return ExactValue(size, slopes, x)

    def _all(self, values: np.ndarray) -> np.ndarray:
        return np.concatenate([np.zeros(4), values])

    # -------------------------------------------------------------------------------------- Newton's method

    def reached(self, quantities: Sequence[ExactQuantity], values: np.ndarray) -> np.ndarray | None:
        """Return the nearest values at which all quantities have their targets; None if they are not reached.

        Each step is the shortest in relative changes of the parameters.
        """
        space, first = self._request.space, values
        within = np.array([of.within for of in quantities])
        target = np.array([of.target for of in quantities])
        try:
            exact = [self.value(of, values) for of in quantities]
            for _ in range(MOST):
                missing = (np.array([f.value for f in exact]) - target) / within
                if np.abs(missing).max() < ACCURACY:
                    return values
                unit = space.units(values)
                slopes = np.array([f.slopes for f in exact]) * unit / within[:, None]
                move = np.linalg.lstsq(slopes, -missing, rcond=1e-8)[0]
                move *= min(1.0, LARGEST / max(float(np.abs(move).max()), 1e-300))
                values = values + move * unit
                if not np.isfinite(values).all() or (np.sign(values) * np.sign(first) < 0).any():
                    return None
                exact = [self.value(of, values, last) for of, last in zip(quantities, exact, strict=True)]
        except (QuantityLost, AnalysisError, np.linalg.LinAlgError):
            return None
        return None

    def values(self, wanted: Sequence[ExactQuantity | None], values: np.ndarray) -> list[ExactValue | None]:
        """Return each quantity at values of the parameters; None where there is none."""
        out: list[ExactValue | None] = []
        for of in wanted:
            try:
                out.append(None if of is None or self.why else self.value(of, values))
            except (QuantityLost, AnalysisError, np.linalg.LinAlgError):
                out.append(None)
        return out


def _width(above: np.ndarray, step: float, periodic: bool) -> tuple[float, np.ndarray]:
    """Return the width of the peak with the highest sample, and its derivative in the activation."""
    n, top = above.size, int(above.argmax())
    slope, total = np.zeros(n), 0.0
    if above[top] <= 0:
        raise QuantityLost
    for side in (1, -1):
        k, steps = top, 0
        while True:
            beside: Any = (k + side) % n if periodic else k + side
            if not 0 <= beside < n or steps >= n:
                break
            if above[beside] <= 0:
                a, b = float(above[k]), float(above[beside])
                total += a / (a - b)
                slope[k] += -b / (a - b) ** 2
                slope[beside] += a / (a - b) ** 2
                break
            k, steps = beside, steps + 1
        total += steps
    return total * step, slope * step
