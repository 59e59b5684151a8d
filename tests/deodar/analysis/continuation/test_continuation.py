"""Branches against closed forms, theory, and runs of the model."""

from __future__ import annotations

import re

import numpy as np
import pytest

import deodar as dd
from deodar.errors import AnalysisError, ParameterError
from tests.deodar.analysis.continuation.models import line, node, node_folds, oscillator, plane, rivals


def kinds(branch) -> list[tuple[str, str]]:
    return [(b.kind, b.instability) for b in branch.bifurcations]


# ------------------------------------------------------------------------------------------------------ nodes


def test_the_folds_of_a_node_are_those_of_the_closed_form():
    branch = dd.continuation(node(), "s.amplitude", (0, 8))
    assert kinds(branch) == [("fold", "detection"), ("fold", "reverse detection")]
    folds = [b.value for b in branch.bifurcations]
    assert folds == pytest.approx(node_folds(), abs=1e-9)
    assert branch.not_refined == "no element has an axis"
    assert branch.ended == ("start", "span") and branch.values[-1] == pytest.approx(8.0)
    np.testing.assert_array_equal(np.unique(np.diff(np.sign(np.diff(branch.values)))), [-2, 0, 2])


def test_a_node_below_its_cusp_has_no_fold():
    """The cusp is at w = 4 / beta = 1."""
    assert kinds(dd.continuation(node(0.99), "s.amplitude", (3, 6))) == []
    assert len(kinds(dd.continuation(node(1.05), "s.amplitude", (3, 6)))) == 2


def test_the_sensitivity_of_a_fold_is_that_of_the_closed_form():
    fold = dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations[0]
    h = 1e-5
    by_excitation = (node_folds(6 + h)[0] - node_folds(6 - h)[0]) / (2 * h)
    by_beta = (node_folds(6, 4 + h)[0] - node_folds(6, 4 - h)[0]) / (2 * h)
    assert fold.sensitivity["u.kernel.0.amplitude"] == pytest.approx(by_excitation, abs=1e-8)
    assert fold.sensitivity["u.sigmoid.beta"] == pytest.approx(by_beta, abs=1e-8)
    assert fold.sensitivity["u.resting_level"] == pytest.approx(-1.0, abs=1e-9)


@pytest.mark.parametrize(("dt", "euler"), [(1.0, -0.07289), (0.1, -0.05222)])
def test_two_nodes_oscillate_where_the_trace_is_zero_and_later_with_a_longer_step(dt: float, euler: float):
    branch = dd.continuation(oscillator(dt), "e.resting_level", (-4, 6))
    first, second = branch.bifurcations
    assert [b.kind for b in branch.bifurcations] == ["Hopf", "Hopf"]
    d, parameters = first.line.right_hand_side, np.array([first.value])
    jacobian = d.linear(first.state, parameters)[1] / d.time_constants[:, None]
    assert np.trace(jacobian) == pytest.approx(0.0, abs=1e-9)
    assert first.frequency == pytest.approx(np.sqrt(np.linalg.det(jacobian)), abs=1e-9)
    assert first.value + second.value == pytest.approx(3.5, abs=1e-8), "the equations are odd about 1.75"
    assert first.step_value == pytest.approx(euler, abs=1e-5)


def test_the_period_near_a_hopf_point_is_that_of_the_run():
    first = dd.continuation(oscillator(0.2), "e.resting_level", (-4, 2)).bifurcations[0]
    model = oscillator(0.2)
    model.set("e.resting_level", first.value + 0.05)
    record = dd.simulate(model, 40_000, dt=0.2, record="e.activation", every=1.0, precision="float64")
    u = record["e.activation"].values[-4000:]
    rises = np.flatnonzero((u[:-1] < u.mean()) & (u[1:] >= u.mean()))
    assert np.ptp(u) > 0.05
    assert np.diff(rises).mean() == pytest.approx(2 * np.pi / first.frequency, rel=0.03)


# ----------------------------------------------------------------------------------------------------- fields


def test_detection_and_reverse_detection_of_a_field():
    """Bisection with settling of 3000 time constants gives 4.326962 and 3.049413, within 5e-6."""
    branch = dd.continuation(line(), "s.amplitude", (0, 8))
    assert kinds(branch) == [("fold", "detection"), ("fold", "reverse detection")]
    up, down = branch.bifurcations
    assert up.value == pytest.approx(4.326962, abs=2e-5)
    assert down.value == pytest.approx(3.049413, abs=2e-5)
    assert up.fine_value == pytest.approx(up.value, abs=1e-6) and up.by_grid is False
    assert abs(up.rate) < 1e-9 and np.linalg.norm(up.vector) == pytest.approx(1.0)
    assert up.state_by_path["u.activation"].shape == (101,)
    assert up.words == "detection of u (fold: two steady states meet and vanish)"


def test_stable_states_attract_the_model_and_unstable_ones_do_not():
    model = line()
    branch = dd.continuation(model, "s.amplitude", (0, 8), finer=False)
    for number in range(0, len(branch.values), 6):
        model.set("s.amplitude", float(branch.values[number]))
        session = dd.Session(model, precision="float64")
        start = branch.state(number)["u.activation"]
        kick = 1e-3 * np.exp(-((np.arange(101) - 50) ** 2) / 50)
        d = branch.line.right_hand_side
        end = d.state(d.settle(d.vector({"u.activation": start + kick}), branch.values[[number]], 400))
        apart = float(np.abs(end["u.activation"] - start).max())
        assert (apart < 1e-5) == bool(branch.stable[number])
        assert session.document.step == 1.0


def test_a_memory_is_forgotten_at_a_fold_and_the_grid_makes_others():
    """On 101 samples the branch folds wherever the peak loses a sample; on 201 samples once."""
    branch = dd.continuation(
        line(excitation=22, inhibition=0.4),
        "boost.amplitude",
        (0, -4),
        induced_by={"s.amplitude": 8.0},
        even=["x"],
    )
    named = [b for b in branch.bifurcations if b.instability]
    assert [b.instability for b in named] == ["forgetting"]
    assert named[0].value == pytest.approx(-1.685172, abs=1e-5)
    assert named[0].fine_value == pytest.approx(-1.602856, abs=1e-5)
    by_grid = [b for b in branch.bifurcations if b.by_grid]
    assert len(by_grid) == 4 and "made by the grid" in by_grid[0].words


@pytest.mark.parametrize("even", [(), ("x",)])
def test_a_peak_that_may_stand_anywhere_has_one_neutral_mode_and_one_fold(even):
    """On a ring without input all places are equal: the shift of the peak neither grows nor decays."""
    x = dd.Axis("x", 0, 100, samples=101, periodic=True)
    model = dd.Model("ring")
    kernel = [dd.Gaussian(22, 5, normalized=True)]
    field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.4)
    u = model.add(field)
    model.set("u.sigmoid.beta", 1.0)
    model.add(dd.GaussianStimulus("s", [x], center=50, sigma=5, amplitude=0.0)) >> u
    model.add(dd.Boost("boost", [x], amplitude=0.0)) >> u
    branch = dd.continuation(
        model, "boost.amplitude", (0, -4), induced_by={"s.amplitude": 8.0}, even=even, finer=False
    )
    assert kinds(branch) == [("fold", "forgetting")]
    assert branch.bifurcations[0].value == pytest.approx(-1.33856, abs=5e-5)
    line = branch.line
    rates = line.at(line.point(branch.states[0], branch.values[0])).rates() * line.slowest
    assert (rates == 0).sum() == (0 if even else 1)
    assert branch.stable[0]


def test_two_equal_inputs_are_selected_at_a_branch_point():
    """Bisection gives 0.3235."""
    branch = dd.continuation(rivals(), "u.global_inhibition", (0.1, 0.5), finer=False)
    assert kinds(branch) == [("branch point", "selection")]
    point = branch.bifurcations[0]
    assert point.value == pytest.approx(0.323406, abs=1e-5)
    assert point.vector @ point.vector[::-1] == pytest.approx(-1.0, abs=1e-9), "the mode is odd"
    left, right = branch.switch(point, (0.05, 0.5))
    mirrored = left.read("u.activation")[:, ::-1]
    np.testing.assert_allclose(mirrored[:8], right.read("u.activation")[:8], atol=1e-6)
    assert not left.stable[0], "the branch leaves towards smaller inhibition, and is unstable there"
    assert left.bifurcations[0].kind == "fold"
    assert left.bifurcations[0].value == pytest.approx(0.087682, abs=1e-5)
    with pytest.raises(AnalysisError, match="no branch leaves a fold"):
        branch.switch(left.bifurcations[0])


def test_a_field_over_two_axes_is_followed_without_matrices():
    branch = dd.continuation(plane(), "s.amplitude", (0, 9), finer=False)
    assert branch.line.right_hand_side.size == 900
    assert kinds(branch) == [("fold", "detection"), ("fold", "reverse detection")]
    up = branch.bifurcations[0]
    d = branch.line.right_hand_side
    for shift, peak in ((-0.02, False), (0.02, True)):
        end = d.settle(d.start, np.array([up.value + shift]), 2000)
        assert bool(end.max() > 0) is peak
    assert up.sensitivity["u.resting_level"] == pytest.approx(
        (_detection(-5.001) - _detection(-4.999)) / -0.002, abs=1e-4
    )


def _detection(resting_level: float) -> float:
    model = plane()
    model.set("u.resting_level", resting_level)
    return dd.continuation(model, "s.amplitude", (0, 6), finer=False).bifurcations[0].value


def test_a_parameter_that_rebuilds_can_be_followed():
    model = line()
    model.set("s.amplitude", 4.2)
    branch = dd.continuation(model, "u.kernel.0.sigma", (5, 3), finer=False)
    assert branch.bifurcations[0].instability == "detection"


# --------------------------------------------------------------------------------------------------- messages


@pytest.mark.parametrize("span", [(1, 1), (0,), "ab", (0, float("nan")), (0, float("inf")), None])
def test_a_span_that_is_none_is_refused(span):
    with pytest.raises(ParameterError, match="the span is"):
        dd.continuation(node(), "s.amplitude", span)


def test_a_model_without_a_steady_state_says_what_still_changes():
    model = node()
    model.add(dd.Boost("rise", amplitude=0.1)) >> model.add(dd.Integrator("sum"))
    with pytest.raises(AnalysisError, match=r"no steady state near the one .*: sum.x still changes by"):
        dd.continuation(model, "s.amplitude", (0, 8))


def test_a_stimulus_outside_of_its_windows_is_named():
    model = line(31)
    model.set("s.windows", [(100.0, 200.0)])
    with pytest.raises(AnalysisError, match=r"s.amplitude: changes nothing .*, at time 0.*at=200"):
        dd.continuation(model, "s.amplitude", (0, 8))
    assert dd.continuation(model, "s.amplitude", (0, 8), at=150, finer=False).bifurcations


def test_a_field_that_is_held_is_constant_and_has_no_name():
    model = node()
    model.add(dd.Field("v", tau=10, resting_level=-3.0))
    model["v"] >> model["u"]
    whole, held_branch = (
        dd.continuation(model, "s.amplitude", (0, 8), hold=hold, finer=False) for hold in ((), ("v",))
    )
    assert list(held_branch.state(0)) == ["u.activation"]
    assert kinds(whole) == kinds(held_branch) == [("fold", "detection"), ("fold", "reverse detection")]
    assert [b.value for b in held_branch.bifurcations] == pytest.approx(
        [b.value for b in whole.bifurcations], abs=1e-6
    )


def test_the_parameter_of_the_span_cannot_induce_the_state():
    with pytest.raises(ParameterError, match="Leave it out of induced_by"):
        dd.continuation(node(), "s.amplitude", (0, 8), induced_by={"s.amplitude": 3})


def test_what_was_found_is_plain_data():
    branch = dd.continuation(node(), "s.amplitude", (0, 8))
    summary = branch.data()
    assert summary["bifurcations"][0]["instability"] == "detection" and summary["stable"] < summary["states"]
    assert re.search(r"fold +detection +3.96637", repr(branch))
