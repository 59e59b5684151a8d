"""The warning about memories on coarse grids, and its stored table."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import deodar as dd
from deodar.errors import Problem
from deodar.model.check import check
from deodar.model.checks._grid_errors import coarsest, percent
from deodar.model.checks.resolution import CHEAPER, MOST, steepness
from deodar.model.proposed import apply
from deodar.numerics.sigmoids import Absolute, Linear, Step


def memory(
    samples: int = 101, sigmoid: object = None, strength: float = 18, dimensions: int = 1, **options: object
) -> dd.Model:
    axes = [dd.Axis(name, 0, 100, samples) for name in "xyz"[:dimensions]]
    model = dd.Model("memory")
    settings = {
        "sigmoid": sigmoid or dd.Logistic(4),
        "kernel": [dd.Gaussian(strength, 5, normalized=True)],
        "global_inhibition": 0.3 if dimensions == 1 else 0.01,
    }
    u = model.add(dd.Field("u", axes, **(settings | options)))  # type: ignore[arg-type]
    model.add(dd.GaussianStimulus("s", axes, center=50, amplitude=8, windows=[(0, 400)])) >> u
    return model


def warned(model: dd.Model) -> list[Problem]:
    return [p for p in check(model.document) if "its grid is coarse" in p.what]


def samples(model: dd.Model) -> int:
    (axis,) = model["u"].element.axes  # type: ignore[attr-defined]
    return axis.samples


@pytest.mark.parametrize(("dimensions", "strength"), [(1, 18), (2, 22)])
def test_a_memory_on_a_coarse_grid_gets_a_warning_with_its_error(dimensions: int, strength: float) -> None:
    (problem,) = warned(memory(dimensions=dimensions, strength=strength, samples=51))
    assert re.search(r"thresholds are (probably \d+ %|more than 50 %) off", problem.what)
    assert "peaks stick to samples" in problem.what
    assert "quadrature" in problem.fix and "samples=" in problem.fix


@pytest.mark.parametrize("count", [81, 101, 121])
@pytest.mark.parametrize("sigmoid", [dd.Logistic(4), dd.Logistic(8), Absolute(2)])
def test_the_cheaper_fix_removes_the_warning(sigmoid: object, count: int) -> None:
    model = memory(samples=count, sigmoid=sigmoid)
    (problem,) = warned(model)
    model.apply_fix(model.check()[0])
    assert warned(model) == []
    u = model["u"].element
    assert isinstance(u, dd.Field)
    if u.quadrature == "cell":
        needed = int(problem.fix.split("samples=")[1].split()[0])
        assert samples(model) == count and needed > CHEAPER[0] * count
        assert warned(memory(samples=needed, sigmoid=sigmoid)) == []
    else:
        assert count < samples(model) <= math.ceil(CHEAPER[0] * count)


def test_too_few_samples_for_means_over_cells_are_reported_too() -> None:
    model = memory(samples=25, sigmoid=dd.Logistic(2), quadrature="cell")
    (problem,) = warned(model)
    assert "stick" not in problem.what and "a width of its kernel has 1.2 samples of 'x'" in problem.what
    model.apply_fix(model.check()[0])
    assert warned(model) == [] and 25 < samples(model) < 51


def test_for_a_step_the_error_falls_with_the_step_of_the_grid_and_cells_are_proposed() -> None:
    errors = []
    for count in (501, 1001, 2001):
        (problem,) = warned(memory(sigmoid=Step(), samples=count))
        errors.append(float(re.search(r"probably ([\d.]+) %", problem.what)[1]))  # type: ignore[index]
    assert errors[0] > 1.8 * errors[1] > 3 * errors[2] > 3
    (problem,) = warned(memory(sigmoid=Step()))
    assert 'quadrature = "cell"' in problem.fix_at("page") and "samples=" not in problem.fix


def test_the_fix_of_a_line_that_others_share_gives_all_of_them_more_samples() -> None:
    model = memory(samples=121)
    model["u"] >> model.add(dd.Field("v", model["u"].element.axes))  # type: ignore[attr-defined]
    model.apply_fix(next(p for p in model.check() if "its grid is coarse" in p.what))
    assert len({e.element.axes[0].samples for e in model.document.entries}) == 1  # type: ignore[attr-defined]


@pytest.mark.parametrize("axes", [1, 2, 3])
@pytest.mark.parametrize("quadrature", ["point", "cell"])
@pytest.mark.parametrize("sharpness", [10.0, 20.0, 70.0, 500.0])
def test_the_error_of_the_table_rises_with_the_step(axes: int, quadrature: str, sharpness: float) -> None:
    limit = coarsest(quadrature, axes, sharpness, MOST)
    errors = [percent(quadrature, axes, sharpness, c * limit) for c in np.geomspace(0.1, 30, 60)]
    assert errors == sorted(errors) and errors[0] < MOST < errors[-1]
    assert percent(quadrature, axes, sharpness, limit) == pytest.approx(MOST, rel=0.01)


@pytest.mark.parametrize("quadrature", ["point", "cell"])
@pytest.mark.parametrize("beta", [1.0, 2.0, 3.0, 6.0, 8.0, 12.0, 50.0])
def test_a_fix_has_edits_that_remove_the_warning_on_every_coarse_grid(beta: float, quadrature: str) -> None:
    for count in (13, 19, 25, 31, 41, 51, 71):
        model = memory(samples=count, sigmoid=dd.Logistic(beta), quadrature=quadrature)
        for problem in warned(model):
            fixed = dd.Model(document=apply(model.document, problem.edits))
            assert problem.edits and warned(fixed) == [], (count, problem)


def test_grids_that_are_coarse_for_cells_too_are_reported() -> None:
    for beta, count in ((4, 25), (4, 17), (4, 11), (8, 13), (8, 11), (12, 41), (50, 41)):
        assert warned(memory(samples=count, sigmoid=dd.Logistic(beta), quadrature="cell")), (beta, count)


def test_a_field_that_is_on_at_rest_has_no_estimate() -> None:
    assert warned(memory(sigmoid=Step(), resting_level=0.0)) == []


@pytest.mark.parametrize(
    "model",
    [
        memory(samples=201),
        memory(sigmoid=dd.Logistic(1.5)),
        memory(strength=8),
        memory(sigmoid=Linear(0.01)),
        memory(kernel=()),
        memory(kernel=[dd.Gaussian(18, 5, normalized=True)], global_inhibition=0.0),
    ],
    ids=["fine grid", "flat sigmoid", "no memory", "linear", "no interaction", "no peak but a front"],
)
def test_fields_on_fine_grids_or_without_memory_get_no_warning(model: dd.Model) -> None:
    assert warned(model) == []


def test_the_estimate_is_the_slope_of_amaris_peak() -> None:
    """On a line with a step: width w with 9 erf(w / (5 sqrt 2)) - 0.3 w = 5, slope k(0) - k(w)."""
    low, high = 8.0, 40.0  # the excitation grows slower than the inhibition between them
    while high - low > 1e-9:
        w = (low + high) / 2
        low, high = (w, high) if 9 * math.erf(w / (5 * math.sqrt(2))) - 0.3 * w > 5 else (low, w)
    slope = 18 / (5 * math.sqrt(2 * math.pi)) * (1 - math.exp(-0.5 * (w / 5) ** 2))
    assert steepness(memory()["u"].element) == pytest.approx([4 * slope], rel=0.01)
