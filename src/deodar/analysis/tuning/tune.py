"""Tuning: parameters of one field at which it has a stated regime."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Unpack

import numpy as np

from deodar.analysis.tuning.exact_values import ExactField, ExactValue
from deodar.analysis.tuning.judge import CandidateJudge
from deodar.analysis.tuning.request import TuneOptions, requested
from deodar.analysis.tuning.requirement import ExactQuantity, Requirement
from deodar.analysis.tuning.search import WIDEST, RegionSize, centred, region_size, searched, together
from deodar.analysis.tuning.tuned import Tuned, result
from deodar.model.model import Model
from deodar.progress import telling
from deodar.resources import Resources, use_resources

ROUNDS = 2
"""How often the values are moved to the middle of the region and back to the exact values."""

FEW = 128
"""Random points by which the regions around several values are compared."""

LEAST = 0.01
"""Least standard deviation of the points between which they are moved."""


def tune(
    model: Model,
    parameters: Sequence[str],
    requirements: Sequence[Requirement],
    field: str = "",
    bounds: Mapping[str, tuple[float, float]] | None = None,
    on: Resources = Resources(),
    **options: Unpack[TuneOptions],
) -> Tuned:
    """Find values of parameters at which a field meets requirements, near the middle of their region.

    The field is measured alone, without noise, as by `dd.regimes`. The search draws random points and
    continues with CMA-ES from the best. What it finds is moved to the middle of the region in which all
    requirements are met; then Newton's method reaches stated values exactly, if the others stay met. If no
    candidate meets all, the result is the best one, and says what it misses.

    Args:
        model: the model, which is not changed.
        parameters: paths of the parameters.
        requirements: what the field is to do, such as `dd.detects(at=3, within=0.2)`.
        field: path of the field or node; empty: the only one.
        bounds: lowest and highest value by path; else a tenth and ten times the present value, inside the
            range of the parameter.
        on: its `progress` counts candidates, and has the lowest `margin` of the best.
        strength: amplitude of the inputs; None: 1.2 times the required detection threshold, or without one
            1.2 times the distance between resting level and threshold.
        seed: seed of the search; equal seeds give equal results on one machine (0).
        budget: most candidates of the search (8000).
        limit: longest stage, in time constants (300).
        sigma: width of the inputs; None: that of the kernel's excitation in the model, for all candidates.
        center: position of the single input; None: the sample nearest to the middle.
        precision: float32 or float64, of the search.
        dt: Euler step; None: a tenth of the time constant.
        inputs: elements of the model kept as constant inputs.

    Raises:
        AnalysisError: the element is not a field with one axis or none, a parameter does not belong to it or
            changes no regime, or requirements contradict each other.
        ParameterError: changing a parameter needs another program, or a value or bound is not one.
        UnknownName: a path is unknown.
        MissingExtra: the package cma is not installed.
    """
    progress = use_resources(on, "dd.tune", "progress").progress
    request = requested(model, parameters, requirements, field, bounds, options)
    with telling(progress, "tuning", "candidates") as tell:
        return _tuned(CandidateJudge(request, tell))


def _tuned(judge: CandidateJudge) -> Tuned:
    """Search, centre and measure candidates; an interrupted search returns the best one."""
    request = judge.request
    equations: ExactField | None = None
    computed: list[ExactValue | None] = [None] * len(request.requirements)
    size: RegionSize | None = None
    interrupted = False
    values = request.space.present
    try:
        values = searched(judge)
        if judge.best_margins.min() >= 0:
            values = centred(judge, values)
            equations = ExactField(request)
            values = _exact(judge, equations, values)
        else:
            equations = ExactField(request)
        computed = equations.values([r.exact(request.strength) for r in request.requirements], values)
        if judge.margins(values[None], "result").min() >= 0:
            size = region_size(judge, values)
    except KeyboardInterrupt:
        interrupted = True
        values = values if judge.best.size == 0 or values is not request.space.present else judge.best
    return result(judge, values, computed, size, interrupted, equations.why if equations else "interrupted")


def _exact(judge: CandidateJudge, equations: ExactField, values: np.ndarray) -> np.ndarray:
    """Return values that have as many stated values exactly as possible, and a large region around them.

    Those that are given return where no stated value is reached, or others are then missed.
    """
    request = judge.request
    quantities: list[ExactQuantity] = [
        quantity for r in request.requirements if (quantity := r.exact(request.strength)) is not None
    ]
    if equations.why:
        return values
    for some in _subsets(quantities):
        best, largest, start = values, -1.0, values
        for _ in range(ROUNDS):
            exact = equations.reached(some, start)
            if exact is None or judge.margins(exact[None], "exact").min() < 0:
                break
            half = together(judge, exact, WIDEST, FEW)
            if half > largest:
                best, largest = exact, half
            start = centred(judge, exact, max(half, LEAST), 2)
        if largest >= 0:
            return best
    return values


def _subsets(quantities: Sequence[ExactQuantity]) -> list[list[ExactQuantity]]:
    """Return which quantities are tried together: all, then fewer.

    Widths and amplitudes are left out first: on a coarse grid they jump from one value to the next.
    """
    ordered = sorted(quantities, key=lambda of: of.of_peak)
    return [list(some) for n in range(len(ordered), 0, -1) for some in combinations(ordered, n)]
