"""Memories on coarse grids, on which their thresholds depend."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from deodar.elements.field import Field
from deodar.errors import DeodarError, EditFix, Fix, Problem
from deodar.leaves import per_axis, replace
from deodar.model import document_files
from deodar.model.checks._grid_errors import QUADRATURES, REST, STEEPEST, coarsest, percent
from deodar.model.checks.noise import correlated
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian, MexicanHat, TruncatedGaussian
from deodar.numerics.sigmoids import Absolute, Logistic, Step
from deodar.proposed_edit import EditValue, SetAxis, SetValues

MOST = 1.0
"""Error of thresholds in percent up to which a grid is fine."""

MOST_FINER = 10.0
"""How many times the samples along an axis are proposed at most (a guess)."""

CHEAPER = (2.0, 2.5, 2.0)
"""How many times the samples of a field over one, two or more axes cost less than means over cells: twice the
samples of a line take at most 1.9 times as long and cells 1.8 to 1.9 times, four times those of a plane 3.1
times and cells 2.8 to 3 times (docs/resolution.md); over more axes nothing was timed.
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
        if not isinstance(e, Field) or (error := _error(e)) <= MOST:
            continue
        most, at = max(zip(_coarseness(e), e.axes, strict=True), key=lambda pair: pair[0])
        if e.quadrature == "cell":
            reason = f"a width of its kernel has {1 / most:.1f} samples of {at.name!r}"
        elif isinstance(e.sigmoid, Step):
            reason = "its sigmoid is a step"
        else:
            change = f"beta times activation changes by {most:.2g} at their edge"
            reason = f"from sample to sample of {at.name!r} {change}"
        stick = "peaks stick to samples, and " if e.quadrature == "point" else ""
        size = f"probably {error:.{0 if error >= 10 else 1}f} %" if error < 50 else "more than 50 %"
        sentence = (
            f"its grid is coarse for peaks that it holds without input ({reason}):"
            f" {stick}thresholds are {size} off"
        )
        yield warning(n, sentence, _finer(wiring, e))


def _finer(wiring: Wiring, field: Field) -> str:
    """Return the fix: the cheaper of more samples and means over cells, and the other one as text."""
    samples, advice = _samples(field), "Use more samples"
    if field.quadrature == "cell":
        return EditFix(advice, _axis_edits(wiring, samples)) if samples else advice
    script, page = (
        " and ".join(f"{text.format(count)} on {axis.name!r}" for axis, count in samples)
        for text in ("samples={}", "{} samples")
    )
    factor = math.prod(count / axis.samples for axis, count in samples)
    if samples and factor <= CHEAPER[min(len(field.axes), len(CHEAPER)) - 1]:
        costs = "which costs more here"
        cells = Fix(f'Or write quadrature="cell", {costs}', page=f"Or average the output over cells, {costs}")
        return EditFix(advice, _axis_edits(wiring, samples), cells)
    needed = _samples(dc.replace(field, quadrature="cell"))  # of a grid that is too coarse for both
    advice = "Average the output over cells" + (" of a finer grid" if needed else "")
    edits = [_over_cells(field, {}), *_axis_edits(wiring, needed)]
    return EditFix(advice, edits, Fix(f"Or write {script}", page=f"Or take {page}") if samples else "")


def _samples(field: Field) -> list[tuple[Axis, int]]:
    """Return the axes that need more samples, and how many; none where they would be too many."""
    limit = coarsest(field.quadrature, len(field.axes), _sharpness(field), MOST)
    shares = [coarse / limit for coarse in _coarseness(field)]
    if max(shares, default=0.0) > MOST_FINER:
        return []
    pairs = zip(field.axes, shares, strict=True)
    return [(axis, math.floor(axis.samples * share) + 1) for axis, share in pairs if share > 1]


def _coarseness(field: Field) -> list[float]:
    """Return how coarse the grid is along each axis, for the field's quadrature; empty without a peak."""
    edges = steepness(field)
    if field.quadrature == "point" or not edges:
        return edges
    _, widths = max(_terms(field), key=lambda term: term[0])
    return [axis.step / width for axis, width in zip(field.axes, widths, strict=True)]


def _axis_edits(wiring: Wiring, samples: Sequence[tuple[Axis, int]]) -> list[SetAxis]:
    """Return the edits that give axes these numbers of samples."""
    keys = {axis: key for key, axis in document_files.axes(wiring.doc).items()}
    return [SetAxis(keys[axis], (("samples", count),)) for axis, count in samples]


def _over_cells(field: Field, values: Mapping[str, EditValue]) -> SetValues:
    """Return the edit that sets values of a field, which it has already, and means over cells."""
    return SetValues(tuple({**values, "quadrature": "cell", **correlated(field)}.items()))


def fix_with_cells(wiring: Wiring, field: Field, fix: str) -> str:
    """Return a fix with new values of a field, and with what its peaks need then: the mean over cells, and
    more samples where the grid is too coarse for it.
    """
    if not isinstance(fix, EditFix) or not all(
        isinstance(e, SetValues) and e.element is None for e in fix.edits
    ):
        return fix
    values = {path: number for e in fix.edits if isinstance(e, SetValues) for path, number in e.values}
    new = field
    try:
        for path, setting in values.items():
            new = replace(new, path, setting)
    except DeodarError:  # the fix with these values states the reason
        return fix
    if new.quadrature != "point" or _error(new) <= MOST:
        return fix
    samples = _samples(dc.replace(new, quadrature="cell"))
    return EditFix(fix.advice, [_over_cells(new, values), *_axis_edits(wiring, samples)], fix.otherwise)


def _error(field: Field) -> float:
    """Return the probable error of thresholds in percent; 0 where it is not known."""
    sharpness = _sharpness(field)
    if field.quadrature not in QUADRATURES or sharpness <= 0 or not (grid := _coarseness(field)):
        return 0.0
    return percent(field.quadrature, len(grid), sharpness, max(grid))


def _sharpness(field: Field) -> float:
    """Return beta times the distance of the resting level from the threshold; 0 where it is not below."""
    distance = getattr(field.sigmoid, "threshold", 0.0) - field.resting_level
    return _beta(field) * distance if distance > 0 else 0.0


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
    if not axes or main[0] <= 0 or beta <= 0:
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
    """Return four times the steepest slope of a sigmoid that saturates, which is the beta of a logistic one;
    for a step that of the steepest sigmoid of the table; else 0.
    """
    match field.sigmoid:
        case Logistic(beta=beta):
            return beta
        case Absolute(beta=beta):
            return 2 * beta
        case Step(threshold=threshold):
            distance = threshold - field.resting_level
            return STEEPEST * REST / distance if distance > 0 else 0.0
        case _:
            return 0.0


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
