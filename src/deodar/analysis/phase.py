"""The phase plot of a node: its rate of change against its activation, with the fixed points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import jax
import numpy as np

from deodar.elements.field import Field
from deodar.errors import AnalysisError
from deodar.numerics import interaction
from deodar.numerics.processor import on_cpu
from deodar.summary import Summarised, Summary, counted

COARSE = 2001
MOST_DOUBLINGS = 12


@dataclass(frozen=True, repr=False)
class FixedPoint(Summarised):
    """An activation at which the rate of change passes through zero.

    Attributes:
        u: activation.
        stable: whether the fixed point is an attractor (the rate falls through zero) or a repeller (it
            rises).
        at_jump: whether the rate jumps across zero (a step output function) instead of being zero.
    """

    u: float
    stable: bool
    at_jump: bool = False

    def _summary(self) -> Summary:
        kind = "Attractor" if self.stable else "Repeller"
        return Summary(f"{kind} at {self.u:.6g}{', at a jump' if self.at_jump else ''}")


@dataclass(frozen=True, repr=False)
class Phase(Summarised):
    """The rate of change du/dt of a node against u, for one constant input.

    Attributes:
        input: the constant input.
        u: activations.
        rate: du/dt at each, in activation per time unit.
        fixed_points: the fixed points, in the order of u.
    """

    input: float
    u: np.ndarray
    rate: np.ndarray
    fixed_points: tuple[FixedPoint, ...]

    @property
    def bistable(self) -> bool:
        """Whether the node has more than one stable fixed point."""
        return sum(p.stable for p in self.fixed_points) > 1

    def _summary(self) -> Summary:
        rows = [
            ("stable" if p.stable else "unstable", p.u, "at a jump" if p.at_jump else "")
            for p in self.fixed_points
        ]
        return Summary(f"Phase plot at input {self.input:g}: {counted(len(rows), 'fixed point')}", rows)


def phase(node: Field, input: float = 0.0, span: tuple[float, float] | None = None) -> Phase:
    """Compute the phase plot of a node: du/dt = (-u + h + s + (k - c) g(u)) / tau, in float64.

    Fixed points are the sign changes of du/dt on a grid that is fine near the output function's threshold,
    each refined to 1e-12. Two fixed points that coincide (exactly at an instability) are not found.

    Args:
        node: a field without axes; its noise is ignored.
        input: s, constant.
        span: lowest and highest activation; none: wide enough for all fixed points.

    Raises:
        AnalysisError: if the field has axes, or its activation grows without bound.

    Reference:
        Schöner, Spencer & the DFT Research Group (2016), Dynamic Thinking, chapter 1 (dynamics of a
        self-excited neuron).
    """
    if node.axes:
        raise AnalysisError(
            f"a phase plot is for a node; this field has {len(node.axes)} axes", where=node.name
        )
    rate = _rate(node, float(input))
    low, high = _range(rate, node, float(input)) if span is None else (float(span[0]), float(span[1]))
    if not low < high:
        raise AnalysisError(f"the span goes from {low:g} to {high:g}; the first has to be lower")
    threshold = float(getattr(node.sigmoid, "threshold", 0.0))
    distances = np.geomspace(1e-9, max(high - low, 1e-6), 400)
    grid = np.unique(
        np.concatenate([np.linspace(low, high, COARSE), threshold - distances, threshold + distances])
    )
    grid = grid[(grid >= low) & (grid <= high)]
    u = np.linspace(low, high, COARSE)
    return Phase(float(input), u, rate(u), _fixed_points(rate, grid))


def _rate(node: Field, s: float) -> Callable[[np.ndarray], np.ndarray]:
    def rate(values: np.ndarray) -> np.ndarray:
        with on_cpu(), jax.enable_x64(True):
            u = jax.numpy.asarray(values, np.float64)
            g = node.sigmoid(u)
            change = (
                -u
                + node.resting_level
                + s
                + interaction.apply(interaction.mix(node.kernel, (), []), (), g)
                - node.global_inhibition * g
            )
            return np.asarray(change / node.tau)

    return rate


def _range(rate: Callable[[np.ndarray], np.ndarray], node: Field, s: float) -> tuple[float, float]:
    """Return a range of activation, slightly beyond the outermost fixed points, at whose ends the rate points
    inwards.
    """
    middle, reach = node.resting_level + s, 1.0 + abs(node.resting_level)
    ends: list[float] = []
    for side in (-1, 1):
        distance = reach
        for _ in range(MOST_DOUBLINGS):
            outside = np.linspace(middle + side * distance, middle + side * 4 * distance, 200)
            if np.all(side * rate(outside) < 0):
                break
            distance *= 2
        else:
            raise AnalysisError(
                "the activation grows without bound: the output function's slope times the self-excitation"
                " exceeds 1",
                where=node.name,
            )
        ends.append(middle + side * distance)
    roots = [p.u for p in _fixed_points(rate, np.linspace(ends[0], ends[1], COARSE))]
    margin = max(0.25 * (max(roots) - min(roots)), 0.1 * reach) if roots else reach
    threshold = float(getattr(node.sigmoid, "threshold", 0.0))
    return min([*roots, threshold]) - margin, max([*roots, threshold]) + margin


def _fixed_points(rate: Callable[[np.ndarray], np.ndarray], grid: np.ndarray) -> tuple[FixedPoint, ...]:
    from scipy import optimize  # start-up time

    values = rate(grid)
    points: list[FixedPoint] = []
    for i in np.flatnonzero(values == 0.0):  # the rate is exactly 0 here: the neighbours give the direction
        if 0 < i < len(grid) - 1 and values[i - 1] * values[i + 1] < 0:
            points.append(FixedPoint(float(grid[i]), bool(values[i - 1] > 0)))
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        a, b = float(grid[i]), float(grid[i + 1])
        u = float(optimize.brentq(lambda v: float(rate(v)), a, b, xtol=1e-12, rtol=1e-14))  # pyright: ignore[reportArgumentType]
        # at a jump the rate is not near zero on either side
        gap = np.abs(rate(np.array([u - 1e-9, u + 1e-9]))).min()
        at_jump = bool(gap > 1e-3 * np.abs(values[[i, i + 1]]).max() and gap > 1e-6 * np.abs(values).max())
        points.append(FixedPoint(u, bool(values[i] > 0), at_jump))
    return tuple(sorted(points, key=lambda p: p.u))
