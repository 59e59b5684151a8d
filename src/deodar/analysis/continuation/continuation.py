"""Continuation: the steady states of a model as a function of one parameter."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.branch import SteadyBranch, branch
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.refinement import checked
from deodar.analysis.continuation.right_hand_side import RightHandSide, right_hand_side
from deodar.analysis.continuation.walk import WalkPoint, begun, walk
from deodar.errors import AnalysisError, ParameterError, option
from deodar.model.model import Model
from deodar.parameters import show

MOST = 1000
"""Largest number of states of a branch."""

SETTLING = 200.0
"""Time constants for which the model runs before Newton's method begins."""


def continuation(
    model: Model,
    parameter: str,
    span: tuple[float, float],
    induced_by: Mapping[str, float] | None = None,
    at: float = 0.0,
    hold: Sequence[str] = (),
    even: Sequence[str] = (),
    finer: bool = True,
) -> SteadyBranch:
    """Follow the steady states of a model, stable and unstable, as one parameter changes.

    The branch begins with the state to which the model settles at the first value of the span, and turns at
    folds. Bifurcations on it are located, and named where peaks appear, vanish, or lose.

    Args:
        model: the model; noise is off.
        parameter: path of the parameter, a live number or one that rebuilds.
        span: first and last value; the branch ends where it leaves the interval between them.
        induced_by: values of other parameters at which the model settles first, before it settles with its
            own: the input of a peak that outlives it.
        at: document time at which stimuli are evaluated.
        hold: paths of elements whose state is constant, such as what learns.
        even: names of axes about whose middle states are mirror images of themselves; keeps a peak without
            input from being found at every sample.
        finer: whether the branch is followed on a grid twice as fine as well, for the error of each value and
            to recognise what only the grid makes.

    Raises:
        AnalysisError: an element has no steady state, or the model has none at the start of the span.
        ParameterError: a path is unknown, changing the parameter needs another program, or the span is not an
            interval.

    Reference:
        Keller (1977), Numerical solution of bifurcation and nonlinear eigenvalue problems (pseudo-arclength
        continuation). Laing (2014), J. Math. Neurosci. 4:13 (of neural fields).
    """
    ends = _span(span)
    start_values = dict(induced_by or {})
    if parameter in start_values:
        raise ParameterError(
            "is the parameter of the span", where=parameter, fix="Leave it out of induced_by"
        )

    def follow(of: Model) -> SteadyBranch:
        return _followed(
            right_hand_side(of, [parameter, *start_values], at, hold, even), parameter, ends, start_values
        )

    steady = follow(model)
    if not finer:
        return steady

    def fine(of: Model) -> tuple[Sequence[Bifurcation], bool]:
        fine_branch = follow(of)
        return fine_branch.bifurcations, fine_branch.ended[1] in ("span", "closed")

    checks, why = checked(model, steady.bifurcations, abs(ends[1] - ends[0]), fine)
    return dc.replace(steady, bifurcations=checks, not_refined=why)


def _followed(
    equations: RightHandSide, parameter: str, ends: tuple[float, float], start_values: Mapping[str, float]
) -> SteadyBranch:
    """Return the branch that begins where the model settles at the first value."""
    first, last = ends
    length = abs(last - first) / 10
    values = equations.values.copy()
    values[0] = first
    line = ParameterLine(equations, 0, values, length)
    x = equations.start
    if start_values:
        strong = values.copy()
        strong[1:] = list(start_values.values())
        x = equations.settle(x, strong, SETTLING)
    x = equations.settle(x, values, SETTLING)
    start = begun(line, x, first, math.copysign(1.0, last - first))
    if start is None:
        raise AnalysisError(*_unsettled(equations, x, values, parameter, first))
    _require_effect(line, start, parameter, last)
    low, high = sorted((first, last))
    return branch(parameter, (line, walk(line, start, (low, high), MOST)))


def _require_effect(line: ParameterLine, start: WalkPoint, parameter: str, last: float) -> None:
    """Raise an error if the parameter changes nothing in the first state."""
    equations, x, parameters = line.right_hand_side, line.state(start.z), line.all_parameters(start.z)
    parameters_at_end, unit = parameters.copy(), np.zeros(parameters.size)
    parameters_at_end[line.index], unit[line.index] = last, 1.0
    if (
        equations.along(x, parameters, np.zeros(x.size), unit).any()
        or (equations.rates(x, parameters_at_end) != equations.rates(x, parameters)).any()
    ):
        return
    raise AnalysisError(
        f"changes nothing in the steady state, at time {equations.at:g}",
        where=parameter,
        fix=option("If it belongs to a stimulus with windows, name a time inside of them:", "at", "200"),
    )


def _span(span: tuple[float, float]) -> tuple[float, float]:
    try:
        first, last = (float(value) for value in span)
    except (TypeError, ValueError):
        raise ParameterError(f"the span is {show(span)}; expected two numbers") from None
    if not (math.isfinite(first) and math.isfinite(last)) or first == last:
        raise ParameterError(f"the span is {show(span)}; expected two different, finite numbers")
    return first, last


def _unsettled(
    equations: RightHandSide, x: np.ndarray, values: np.ndarray, parameter: str, first: float
) -> tuple[str]:
    """Return a message that says where the model still moves."""
    if not np.isfinite(x).all():
        return (f"the model does not stay finite at {parameter} = {first:g}",)
    state = equations.state(np.abs(equations.rates(x, values)))
    fastest = max(state, key=lambda name: float(np.abs(state[name]).max(initial=0.0)))
    return (
        f"the model has no steady state near the one it reaches at {parameter} = {first:g}: {fastest} still"
        f" changes by {float(np.abs(state[fastest]).max()):.2g} per time constant",
    )
