"""Pseudo-arclength continuation: following steady states around folds, locating what happens between, and
leaving branch points.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from deodar.analysis.continuation.bifurcation import Bifurcation, BifurcationKind
from deodar.analysis.continuation.line import GrowthRates, Linearisation, ParameterLine

ACCURACY = 1e-9
"""Largest residual of a steady state, in units of activation."""

NEUTRAL = 1e-7
"""Growth rate times the longest time constant below which a mode counts as neutral."""

CROSSED = 1e-4
"""Growth rate times the longest time constant above which a located branch point or Hopf point is none: a
mode became neutral, or stopped to be.
"""

STRAY = 0.3
"""Largest distance of a corrected point from its predictor, as a share of the step.

Beyond it the point may lie on another branch: without this bound the lower branch of a 2-D field was left for
the upper one without a fold.
"""

TURN = 0.9
"""Smallest cosine between the directions of two successive points."""

SHORTEST, LONGEST = 1e-7, 0.5
"""Steps along the branch, in root mean square of activation."""


@dataclass(frozen=True)
class WalkPoint:
    """A steady state on the way: its point, the direction of the branch, and its growth rates."""

    z: np.ndarray
    direction: np.ndarray
    rates: GrowthRates


@dataclass
class Walk:
    """What was found on the way.

    Attributes:
        points: the steady states.
        bifurcations: what lies between them.
        ended: why it ended: `span`, `closed`, `points`, or `lost`.
    """

    points: list[WalkPoint]
    bifurcations: list[Bifurcation] = field(default_factory=list[Bifurcation])
    ended: str = ""


def walk(
    line: ParameterLine,
    start: WalkPoint,
    span: tuple[float, float],
    most: int,
    step: float = 0.1,
) -> Walk:
    """Follow a branch from a point until it leaves the span, closes, or has `most` points."""
    walked, size = Walk([start]), step
    while len(walked.points) < most:
        last = walked.points[-1]
        ahead = _advanced(line, last, size)
        if ahead is None or (abs(growing(line, ahead[0]) - growing(line, last)) > 2 and size > 1e-3):
            size /= 2
            if size < SHORTEST:
                walked.ended = "lost"
                return walked
            continue
        after, effort = ahead
        walked.bifurcations += _between(line, last, after, size, len(walked.points) - 1)
        walked.points.append(after)
        if not span[0] <= line.value(after.z) <= span[1]:
            walked.points[-1] = _at_end(line, last, after, span)
            walked.bifurcations = [b for b in walked.bifurcations if span[0] <= b.value <= span[1]]
            walked.ended = "span"
            return walked
        if _closed(walked.points, size):
            walked.ended = "closed"
            return walked
        size = min(1.5 * size, LONGEST) if effort <= 3 else size / 1.5 if effort >= 6 else size
    walked.ended = "points"
    return walked


def with_step_values(line: ParameterLine, walked: Walk) -> list[Bifurcation]:
    """Return the bifurcations; Hopf points with the nearest value at which Euler's step begins to oscillate.

    A mode with the growth rate r changes by 1 + dt r in a step, so that it grows if |1 + dt r| > 1.
    """
    dt = line.right_hand_side.dt
    factors = [_turning(point, dt) for point in walked.points]
    crossings = [k for k in range(len(factors) - 1) if factors[k] * factors[k + 1] < 0]
    out: list[Bifurcation] = []
    for bifurcation in walked.bifurcations:
        if bifurcation.kind == "Hopf" and crossings:
            k = min(crossings, key=lambda k: abs(k - bifurcation.index))
            value = _crossing(line, walked.points[k], walked.points[k + 1], dt)
            bifurcation = dc.replace(bifurcation, step_value=value)
        out.append(bifurcation)
    return out


def _turning(point: WalkPoint, dt: float) -> float:
    """Return |1 + dt r| - 1 of the fastest mode that oscillates; -1 without one."""
    turning = point.rates[np.abs(point.rates.imag) > 1e-9]
    return float(np.abs(1 + dt * turning).max(initial=0.0)) - 1


def _crossing(line: ParameterLine, before: WalkPoint, after: WalkPoint, dt: float) -> float | None:
    """Return the value at which an oscillation of Euler's step begins to grow, between two points."""
    chord = after.z - before.z
    row = chord / np.linalg.norm(chord)
    reached: dict[float, np.ndarray] = {}

    def at(share: float) -> float:
        correction = corrected(line, before.z + share * chord, row)
        if correction is None:
            raise _Lost
        reached[share] = correction[0]
        return _turning(WalkPoint(correction[0], row, correction[1].rates()), dt)

    try:
        return line.value(reached[zero(at)])
    except (_Lost, ValueError, KeyError):
        return None


def begun(line: ParameterLine, x: np.ndarray, value: float, direction: float) -> WalkPoint | None:
    """Return the steady state near x as the first point of a branch towards larger or smaller values; None if
    Newton's method does not find it.
    """
    row = np.zeros(x.size + 1)
    row[-1] = 1.0
    z = line.point(x, value)
    at = line.at(z)
    for _ in range(30):
        size = np.abs(at.residual).max(initial=0.0)
        if size < ACCURACY:
            return WalkPoint(z, tangent(at, direction * row), at.rates())
        move = at.solve(row, np.append(-at.residual, 0.0), 1e-6)
        share = 1.0
        while True:
            new = line.at(z + share * move)
            if np.abs(new.residual).max() < (1 - 1e-4 * share) * size or share < 1e-3:
                break
            share /= 2
        z, at = z + share * move, new
    return None


def tangent(at: Linearisation, before: np.ndarray) -> np.ndarray:
    """Return the unit direction of the branch that continues the one before."""
    right = np.zeros(before.size)
    right[-1] = 1.0
    direction = at.solve(before, right, 1e-8)
    return direction / np.linalg.norm(direction)


def corrected(
    line: ParameterLine, guess: np.ndarray, row: np.ndarray
) -> tuple[np.ndarray, Linearisation, int] | None:
    """Return the steady state in the plane through a guess, across a direction.

    The equations there and the number of Newton steps follow; None if Newton's method does not converge.
    """
    z, before = guess, np.inf
    for effort in range(9):
        at = line.at(z)
        size = np.abs(at.residual).max(initial=0.0)
        if size < ACCURACY and effort > 0:
            return z, at, effort
        if not np.isfinite(size) or size > max(1e4, 100 * before):
            return None
        before = size
        z = z + at.solve(row, -np.append(at.residual, row @ (z - guess)), 1e-5)
    return None


def growing(line: ParameterLine, point: WalkPoint) -> int:
    """Return the number of growing modes."""
    return int((point.rates.real * line.slowest > NEUTRAL).sum())


def _advanced(line: ParameterLine, last: WalkPoint, size: float) -> tuple[WalkPoint, int] | None:
    """Return the next point of the branch, and how many Newton steps it took; None if it may be another
    branch.
    """
    guess = last.z + size * last.direction
    correction = corrected(line, guess, last.direction)
    if correction is None:
        return None
    z, at, effort = correction
    if np.linalg.norm(z - guess) > STRAY * size:
        return None
    ahead = tangent(at, last.direction)
    if ahead @ last.direction < TURN:
        return None
    return WalkPoint(z, ahead, at.rates()), effort


def _at_end(line: ParameterLine, inside: WalkPoint, after: WalkPoint, span: tuple[float, float]) -> WalkPoint:
    """Return the steady state at the end of the span, between a point inside and one outside."""
    end = min(max(line.value(after.z), span[0]), span[1]) / line.length
    guess = inside.z + (after.z - inside.z) * (end - inside.z[-1]) / (after.z[-1] - inside.z[-1])
    row = np.zeros(guess.size)
    row[-1] = 1.0
    correction = corrected(line, guess, row)
    if correction is None:
        return after
    z, at, _ = correction
    return WalkPoint(z, tangent(at, inside.direction), at.rates())


def _closed(points: list[WalkPoint], size: float) -> bool:
    """Return whether the branch has come back to its start."""
    first, last = points[0], points[-1]
    returned = float(np.linalg.norm(last.z - first.z)) < 0.75 * size
    return len(points) > 6 and returned and abs(float(last.direction @ first.direction)) > TURN


# ----------------------------------------------------------------------------------- what lies between points


def _between(
    line: ParameterLine, before: WalkPoint, after: WalkPoint, size: float, index: int
) -> list[Bifurcation]:
    """Return the bifurcations between two points."""
    bifurcations: list[Bifurcation] = []
    turns = before.direction[-1] * after.direction[-1] < 0
    if turns:
        bifurcations.append(_located(line, before, size, index, "fold", lambda ahead, _: ahead[-1]))
    bifurcations += _crossings(line, before, after, size, index, turns)
    return [b for b in bifurcations if b.kind == "fold" or abs(b.rate) * line.slowest < CROSSED]


def _crossings(
    line: ParameterLine, before: WalkPoint, after: WalkPoint, size: float, index: int, turns: bool
) -> list[Bifurcation]:
    """Return the branch point or Hopf point between two points, besides a fold."""
    few, many = sorted((growing(line, before), growing(line, after)))
    crossing_modes = many - few - (1 if turns else 0)
    if crossing_modes <= 0:
        return []
    unstable = after if growing(line, after) > growing(line, before) else before
    crossing = unstable.rates[few:many]
    turning = np.abs(crossing.imag).max() > 1e-6 / line.slowest
    if many - few >= 2 and (turning or crossing_modes >= 2):
        hopf = _located(line, before, size, index, "Hopf", lambda _, at: at.rates()[few + 1].real)
        # a pair that oscillates where it crosses may have become two real modes at the next point
        if turning or hopf.frequency > 1e-6 / line.slowest:
            return [hopf]
    mode = few + (1 if turns and unstable is after else 0)
    return [_located(line, before, size, index, "branch point", lambda _, at: at.rates()[mode].real)]


class _Lost(Exception):
    """Raised inside a search where the branch is not found."""


def zero(of: Callable[[float], float]) -> float:
    """Return a zero between 0 and 1; raise ValueError if both ends have one sign."""
    # start-up time
    from scipy import optimize

    search: Any = optimize.brentq
    return float(search(of, 0.0, 1.0, xtol=1e-13, rtol=1e-12, maxiter=60))


def _located(
    line: ParameterLine,
    before: WalkPoint,
    size: float,
    index: int,
    kind: BifurcationKind,
    test: Callable[[np.ndarray, Linearisation], float],
) -> Bifurcation:
    """Return a bifurcation at the zero of a test along the branch after a point.

    The test is a function of the direction of the branch and of the equations there.
    """
    seen: list[tuple[float, np.ndarray]] = []

    def at(share: float) -> float:
        correction = corrected(line, before.z + share * size * before.direction, before.direction)
        if correction is None:
            raise _Lost
        z, linear, _ = correction
        tested = float(test(tangent(linear, before.direction), linear))
        seen.append((abs(tested), z))
        return tested

    # a failed search leaves the nearest point to the zero that was reached
    with contextlib.suppress(_Lost, ValueError):
        zero(at)
    z = min(seen, key=lambda point: point[0])[1] if seen else before.z
    linear = line.at(z)
    rates = linear.rates()
    nearest = complex(rates[np.argmin(np.abs(rates.real if kind == "Hopf" else rates))])
    frequency = abs(nearest.imag) if kind == "Hopf" else 0.0
    vector = linear.mode(nearest)
    return Bifurcation(kind, line.value(z), line.state(z), vector, nearest.real, frequency, index, line)


# ------------------------------------------------------------------------------------- leaving a branch point


SIZES = (0.05, 0.2, 0.8)
"""Largest activations by which the state is moved along the mode, tried one after another (a guess)."""


def switched(at: Bifurcation, span: tuple[float, float], most: int) -> list[tuple[ParameterLine, Walk]]:
    """Return the walks along the other branch of a branch point, in both directions of its mode."""
    out: list[tuple[ParameterLine, Walk]] = []
    for sign in (1.0, -1.0):
        for size in SIZES:
            begin = _beside(at, sign * size * at.vector / np.abs(at.vector).max())
            if begin is not None:
                out.append((at.line, walk(at.line, begin, span, most, step=0.02)))
                break
    return out


def _beside(at: Bifurcation, move: np.ndarray) -> WalkPoint | None:
    """Return the steady state whose component along a move is that of the move, whatever the parameter.

    None if there is none on another branch.
    """
    line = at.line
    row = np.append(line.weight * move, 0.0)
    row /= np.linalg.norm(row)
    guess = line.point(at.state, at.value) + np.append(line.weight * move, 0.0)
    z = guess
    for _ in range(20):
        linear = line.at(z)
        size = np.abs(linear.residual).max()
        if not np.isfinite(size):
            return None
        if size < ACCURACY:
            moved = (line.state(z) - at.state) @ move / (move @ move)
            if moved < 0.3:
                return None
            return WalkPoint(z, tangent(linear, row), linear.rates())
        z = z + linear.solve(row, -np.append(linear.residual, row @ (z - guess)), 1e-6)
    return None
