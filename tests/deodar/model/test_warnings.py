"""A warning states a probable mistake; it never stops a run."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.model.check import check, problems
from deodar.numerics.axes import Axes
from deodar.numerics.sigmoids import Linear, SemiLinear

X = dd.Axis("x", 0, 10, samples=11)


@dataclass(frozen=True)
class Doubtful(Boost):
    """An element that warns."""

    def warnings(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        yield "is doubtful", "Take another"


def _model() -> dd.Model:
    model = dd.Model("m")
    model.add(Doubtful("b", [X])) >> model.add(dd.Field("u", [X]))
    return model


def test_an_element_warns_with_its_path_and_line() -> None:
    model = _model()
    (problem,) = [p for p in model.check() if p.what == "is doubtful"]
    assert problem.severity == "warning" and problem.fix == "Take another"
    assert problem.where.startswith("b (test_warnings.py:")


def test_a_warning_does_not_prevent_a_run() -> None:
    model = _model()
    assert problems(model.document) == []
    model.require()
    record = dd.simulate(model, duration=3, dt=1, record="u.activation")
    assert np.isfinite(record["u.activation"].values).all()
    session = dd.Session(model, dt=1)
    session.step(2)
    session.set("b.amplitude", 2.0)
    session.step(2)


def test_a_model_with_problems_has_no_warnings() -> None:
    model = _model()
    model.add(dd.Gain(2, name="loose"))
    assert {p.severity for p in check(model.document)} == {"problem"}


@pytest.mark.parametrize("tenth", [0.01, 1.0, 10.0])
@pytest.mark.parametrize("step", [1, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5, 8, 9])
def test_a_periodic_axis_that_counts_its_end_twice_is_found_at_any_round_step(
    step: float, tenth: float
) -> None:
    """With one sample less the step is a number that a person would choose."""
    doubled = [p for p in _ring(70 * step * tenth, 71).check() if "counts its end twice" in p.what]
    assert [p.fix for p in doubled] == ['Leave the second end out: model.set_axis("x", samples=70)']
    for samples in (70, 69):
        assert not any("end twice" in p.what for p in _ring(70 * step * tenth, samples).check())


def _ring(length: float, samples: int) -> dd.Model:
    model = dd.Model("ring")
    model.add(dd.Field("u", [dd.Axis("x", 0, length, samples=samples, periodic=True)]))
    return model


@pytest.mark.parametrize("sigmoid", [Linear(), Linear(slope=0.5), SemiLinear()], ids=str)
@pytest.mark.parametrize(
    ("axes", "excitation", "grows"),
    [([], 0.95, False), ([], 1.1, True), ([X], 0.95, False), ([X], 1.1, False), ([X], 1.3, True)],
)
def test_a_linear_field_grows_if_its_kernel_excites_more_than_it_decays(
    axes: Axes, excitation: float, grows: bool, sigmoid: Linear | SemiLinear
) -> None:
    """Over axes a part of the kernel is lost at the borders, so excitation up to 1.2 is no mistake."""
    kernel = dd.Gaussian(excitation / sigmoid.slope, 1.0, normalized=bool(axes))
    model = dd.Model("linear")
    model.add(dd.Field("u", axes, sigmoid=sigmoid, kernel=[kernel]))
    problems = [p.what for p in model.check() if "grows without bound" in p.what]
    assert len(problems) == grows and all(f"by {excitation:g}" in text for text in problems)


def test_a_window_that_ends_before_it_begins_is_a_problem() -> None:
    model = dd.Model("m")
    model.add(
        dd.GaussianStimulus("s", [X], center=5, amplitude=6, windows=[(0, 50), (300, 100)])
    ) >> model.add(dd.Field("u", [X]))
    (problem,) = model.check()
    assert problem.severity == "problem" and problem.where.startswith("s (")
    assert "windows.1 ends at 100, before it begins at 300" in problem.what and "(100, 300)" in problem.fix


def test_a_window_without_duration_is_a_warning() -> None:
    model = dd.Model("m")
    model.add(dd.GaussianStimulus("s", [X], center=5, amplitude=6, windows=[(100, 100)])) >> model.add(
        dd.Field("u", [X])
    )
    (problem,) = model.check()
    assert problem.severity == "warning" and "is never on" in problem.what


def slow(tau: float, **parameters: float) -> dd.Model:
    model = dd.Model("slow", dt=1)
    model.add(Boost("b", amplitude=1.0)) >> model.add(dd.Field("f", [], tau=tau, **parameters))
    return model


def test_a_state_that_stands_still_in_single_precision_is_named_by_check_and_run() -> None:
    message = (
        r"f.*: does not move in single precision: a step changes it by at most 1e-07, and numbers near -5"
    )
    model = slow(1e7)
    (problem,) = [p for p in model.check() if "does not move" in p.what]
    assert problem.severity == "warning" and "precision=" in str(problem)
    for run in (lambda: dd.Session(model), lambda: dd.simulate(model, 2)):
        with pytest.warns(dd.errors.RunWarning, match=message):
            run()
    ends = []
    for precision in ("float32", "float64"):
        with warnings.catch_warnings(record=True) as issued:
            warnings.simplefilter("always")
            s = dd.Session(model, precision=precision)
        assert bool(issued) == (precision == "float32")
        s.step(1000)
        ends.append(float(s.read("f")) + 5)
    assert ends[0] == 0 and ends[1] == pytest.approx(1e-4, rel=1e-3)
    for moves in (slow(1e4), slow(1e7, resting_level=0.0), slow(1e7, noise=1e3)):
        assert not [p for p in moves.check() if "does not move" in p.what]
    quiet = dd.Model("quiet")
    quiet.add(dd.Field("u", [X])) >> quiet.add(dd.Field("v", [X]))
    assert not quiet.check(), "an input of almost 0 changes nothing in any precision"


def test_a_resting_level_whose_sign_slipped_is_a_warning() -> None:
    def finding(level: float, amplitude: float = 6.0) -> list[dd.errors.Problem]:
        model = dd.Model("m")
        kernel = [dd.Gaussian(10, 1)]
        u = model.add(dd.Field("u", [X], resting_level=level, kernel=kernel, global_inhibition=2))
        model.add(dd.GaussianStimulus("s", [X], center=5, sigma=1, amplitude=amplitude)) >> u
        return [p for p in model.check() if "without any input" in p.what]

    (problem,) = finding(3.0)
    line = 'model.set({"u.resting_level": -3, "u.quadrature": "cell"}) and model.set_axis("x", samples=18)'
    assert problem.severity == "warning"
    assert problem.fix == f"Change the sign: {line}", "its peaks are narrow for the grid"
    assert not finding(-3.0), "what the fix writes"
    assert not finding(3.0, -6.0), "an input may keep it silent"
