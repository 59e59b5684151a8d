"""The warning about noise that is white in space, and its fix."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.errors import Problem

STEP = 0.1


def noisy(element: bool, dimensions: int = 1, quadrature: str = "cell", length: float = 0.0) -> dd.Model:
    """Return a field without interaction; its noise is its own or that of an element."""
    axes = [dd.Axis(n, 0, 3, samples=30, periodic=True) for n in "xy"[:dimensions]]
    model = dd.Model("noisy")
    noise = 0.0 if element else 0.5
    u = model.add(
        dd.Field("u", axes, tau=10, resting_level=0, noise=noise, noise_length=length, quadrature=quadrature)
    )
    if element:
        model.add(dd.Noise("source", axes, amplitude=0.5, length=length)) >> u
    return model


def warned(model: dd.Model) -> list[Problem]:
    return [p for p in model.check() if "white in space" in p.what]


@pytest.mark.parametrize("element", [False, True], ids=["field", "element"])
def test_white_noise_is_reported_where_the_output_is_averaged_over_cells(element: bool) -> None:
    (problem,) = warned(noisy(element))
    assert problem.where.startswith("source (" if element else "u (") and problem.severity == "warning"
    assert warned(noisy(element, length=STEP)) == []
    for quadrature in ("point", "cell-0.1"):
        assert warned(noisy(element, quadrature=quadrature)) == []


def test_noise_is_reported_behind_a_gain_and_not_behind_a_convolution_or_another_field() -> None:
    axes = [dd.Axis("x", 0, 3, samples=30, periodic=True)]
    model = dd.Model("noisy")
    u = model.add(dd.Field("u", axes, quadrature="cell"))
    v = model.add(dd.Field("v", axes))
    model.add(dd.Noise("near", axes, amplitude=0.5)) >> model.add(dd.Gain(2.0, name="gain")) >> u
    model.add(dd.Noise("far", axes, amplitude=0.5)) >> v >> u
    smooth = model.add(dd.Convolve([dd.Gaussian(1.0, 0.5)], name="smooth"))
    model.add(dd.Noise("smoothed", axes, amplitude=0.5)) >> smooth >> u
    assert [problem.where.split()[0] for problem in warned(model)] == ["near"]


def test_a_node_has_no_white_noise_in_space() -> None:
    model = dd.Model("node")
    model.add(dd.Field("u", [], noise=1.0, quadrature="cell"))
    assert warned(model) == []


@pytest.mark.parametrize("element", [False, True], ids=["field", "element"])
@pytest.mark.parametrize("dimensions", [1, 2])
def test_the_fix_is_a_length_of_one_step_that_keeps_the_integral(element: bool, dimensions: int) -> None:
    model = noisy(element, dimensions)
    deviations = []
    for _ in range(2):
        u = dd.simulate(model, 100, trials=300, every=100)["u.activation"].isel(time=-1)
        deviations.append(float(u.mean(["x", "y"][:dimensions]).std("trial")))
        for problem in warned(model):
            model.apply_fix(problem)
    assert warned(model) == [] and model.get("source.length" if element else "u.noise_length") == STEP
    # 300 trials: the standard deviation is known to 4 %; without the strength it would be 50 % or 75 % off
    assert deviations[1] == pytest.approx(deviations[0], rel=0.2)
