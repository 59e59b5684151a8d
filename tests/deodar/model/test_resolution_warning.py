"""The warning about memories whose edges are narrower than a sample."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.model.checks.resolution import STEEP, steepness
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


def warned(model: dd.Model) -> list[str]:
    return [f"{p.what} {p.fix}" for p in model.check() if "narrower than a sample" in p.what]


@pytest.mark.parametrize(("dimensions", "strength"), [(1, 18), (2, 22)])
def test_a_memory_on_a_coarse_grid_gets_a_warning_with_the_line_to_type(
    dimensions: int, strength: float
) -> None:
    (problem,) = warned(memory(dimensions=dimensions, strength=strength, samples=51))
    assert 'model.set("u.quadrature", "cell")' in problem and "samples=" in problem and "'x'" in problem


def test_the_suggested_fix_removes_the_warning() -> None:
    for sigmoid in (dd.Logistic(4), dd.Logistic(30), Absolute(10)):
        (problem,) = warned(memory(sigmoid=sigmoid))
        assert warned(memory(sigmoid=sigmoid, quadrature="cell")) == []
        assert warned(memory(sigmoid=sigmoid, samples=int(problem.split("samples=")[1].split()[0]))) == []


def test_for_a_step_sigmoid_the_warning_suggests_no_number_of_samples() -> None:
    (problem,) = warned(memory(sigmoid=Step(), samples=4001))
    assert 'model.set("u.quadrature", "cell")' in problem and "samples=" not in problem


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
    import math

    low, high = 8.0, 40.0  # the excitation grows slower than the inhibition between them
    while high - low > 1e-9:
        w = (low + high) / 2
        low, high = (w, high) if 9 * math.erf(w / (5 * math.sqrt(2))) - 0.3 * w > 5 else (low, w)
    slope = 18 / (5 * math.sqrt(2 * math.pi)) * (1 - math.exp(-0.5 * (w / 5) ** 2))
    assert steepness(memory()["u"].element) == pytest.approx([4 * slope], rel=0.01)
    assert steepness(memory(samples=201)["u"].element)[0] < STEEP < steepness(memory()["u"].element)[0]
