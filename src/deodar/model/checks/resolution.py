"""Memories whose edges are narrower than a sample, where sums over points depend on the grid."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from deodar.elements.field import Field
from deodar.errors import DeodarError, Problem, assign
from deodar.leaves import per_axis, replace
from deodar.model.checks.noise import correlated
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian, MexicanHat, TruncatedGaussian
from deodar.numerics.sigmoids import Absolute, Logistic, Step
from deodar.proposed_edit import EditValue

STEEP, STEEP_BEYOND = 5.0, 10.0
"""Change of beta u over one sample at the edge of a peak from which sums over points depend on the grid: over
one axis, and over several, where edges cross samples at different positions. Measured by the boost that
erases a memory: on a line it is 3 % to 14 % off at 5.5 and below 1 % off at 3.7 (`python
benchmarks/resolution.py edges`), on a plane 5 % off at 14 and 1.5 % at 7 (`--dimensions 2`).
"""

WIDTHS = np.linspace(0.05, 12.0, 240)
"""Widths of a peak that are tested, in widths of the excitation."""

WHOLE = 0.75
"""Share of an axis from which on a region no longer counts as a peak."""

_erf = np.vectorize(math.erf, otypes=[float])


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check fields with Gaussian kernels of their own that hold peaks without input."""
    for n in wiring.declared:
        e = n.element
        if not isinstance(e, Field) or not (steep := _steep(e)):
            continue
        limit = _limit(e)
        most, at = max(steep, key=lambda pair: pair[0])
        finite = math.isfinite(most)
        edge = (
            f"from sample to sample of {at.name!r} beta times activation changes by {most:.2g}"
            if finite
            else "its sigmoid is a step"
        )
        sentence = (
            f"holds peaks without input whose edges are narrower than a sample ({edge}): peaks stick to"
            " samples, and thresholds depend on the grid"
        )
        finer = (
            " and ".join(
                f"samples={math.ceil(axis.samples * s / limit)} on {axis.name!r}" for s, axis in steep
            )
            if finite
            else ""
        )
        advice = "Average the output over cells"
        cells = {"quadrature": "cell", **correlated(e)}
        yield warning(n, sentence, assign(advice, cells, f"Or write {finer}" if finer else ""))


def with_cells(field: Field, values: Mapping[str, EditValue]) -> dict[str, EditValue]:
    """Return new values for a field, with the mean over cells where its peaks need it then.

    Values that the field cannot have are returned as they are.
    """
    new = field
    try:
        for path, setting in values.items():
            new = replace(new, path, setting)
    except DeodarError:  # the fix with these values states the reason
        return dict(values)
    return {**values, "quadrature": "cell", **correlated(new)} if _steep(new) else dict(values)


def _limit(field: Field) -> float:
    return STEEP if len(field.axes) == 1 else STEEP_BEYOND


def _steep(field: Field) -> list[tuple[float, Axis]]:
    """Return the steepness along each axis on which the edges of peaks are narrower than a sample."""
    if not field.axes or field.quadrature != "point":
        return []
    pairs = zip(steepness(field), field.axes, strict=False)
    return [(s, axis) for s, axis in pairs if s > _limit(field)]


def steepness(field: Field) -> list[float]:
    """Return the change of beta u from sample to sample at the edge of a self-sustained peak, along each
    axis.

    The list is empty where no such peak is known.

    The peak is approximated by a region of g = 1 with straight borders (Amari 1977 on a line). Its width is
    the
    largest at which activation at the border is at the threshold and falls with the width: u = theta there,
    so that h - theta + integral of k over the region - c volume = 0. The slope at the border is k(0) -
    k(width), times the part of the kernel that the region covers along other axes. Known for kernels that are
    sums of Gaussians and for sigmoids that saturate; an estimate, since true peaks are round and their edges
    not sharp.
    """
    axes, terms, beta = tuple(field.axes), _terms(field), _beta(field)
    main = max(terms, key=lambda t: t[0], default=(0.0, []))
    if main[0] <= 0 or beta <= 0:
        return []
    wide = [np.minimum(WIDTHS * s, a.range) for s, a in zip(main[1], axes, strict=True)]
    threshold: float = getattr(field.sigmoid, "threshold", 0.0)
    alone = field.resting_level - threshold - field.global_inhibition * np.prod(wide, axis=0)
    borders, slopes = [], []
    for d in range(len(axes)):
        u, slope = alone, np.zeros(len(WIDTHS))
        for amplitude, sigmas in terms:
            beside = [_erf(wide[e] / (2 * math.sqrt(2) * s)) for e, s in enumerate(sigmas) if e != d]
            part, across = amplitude * np.prod([np.ones(len(WIDTHS)), *beside], axis=0), wide[d] / sigmas[d]
            u = u + part * 0.5 * _erf(across / math.sqrt(2))
            slope = slope + part * (1 - np.exp(-0.5 * across**2)) / (math.sqrt(2 * math.pi) * sigmas[d])
        borders.append(u)
        slopes.append(slope)
    border = np.min(borders, axis=0)
    stable = np.flatnonzero((border[:-1] > 0) & (border[1:] <= 0))
    if not len(stable) or all(w[stable[-1]] > WHOLE * a.range for w, a in zip(wide, axes, strict=True)):
        return []
    return [float(beta * max(slope[stable[-1]], 0.0) * a.step) for slope, a in zip(slopes, axes, strict=True)]


def _beta(field: Field) -> float:
    """Return four times the steepest slope of a sigmoid that saturates (the beta of a logistic one); else
    0.
    """
    g = field.sigmoid
    return (
        g.beta
        if isinstance(g, Logistic)
        else 2 * g.beta
        if isinstance(g, Absolute)
        else math.inf
        if isinstance(g, Step)
        else 0.0
    )


def _terms(field: Field) -> list[tuple[float, list[float]]]:
    """Return the integral and the widths of each Gaussian of the kernel; empty for another kernel."""
    terms: list[tuple[float, list[float]]] = []
    for k in field.kernel:
        if isinstance(k, MexicanHat):
            parts = [
                (k.excitation, k.sigma_excitation, k.normalized),
                (-k.inhibition, k.sigma_inhibition, k.normalized),
            ]
        elif isinstance(k, (Gaussian, TruncatedGaussian)):
            parts = [(k.amplitude, k.sigma, k.normalized)]
        else:
            return []
        for amplitude, sigma, normalized in parts:
            sigmas = [float(s) for s in per_axis(sigma, field.axes)]
            terms.append(
                (
                    amplitude
                    * (1.0 if normalized else math.prod(math.sqrt(2 * math.pi) * s for s in sigmas)),
                    sigmas,
                )
            )
    return terms
