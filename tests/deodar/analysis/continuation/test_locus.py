"""Loci of folds and branch points against closed forms, single branches, and theory."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.locus import Locus, nearest
from deodar.analysis.continuation.right_hand_side import right_hand_side
from deodar.analysis.continuation.walk import begun, walk
from deodar.errors import AnalysisError, FigureError, ParameterError
from tests.deodar.analysis.continuation.models import line, node, node_folds, oscillator, plane, rivals


def test_the_folds_of_a_node_meet_in_a_cusp():
    """Both folds are at s = u - h - w g(u), and the cusp at w = 4 / beta = 1, s = 4.5."""
    fold = dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations[0]
    curve = dd.locus(fold, "u.kernel.0.amplitude", (0.5, 10), (-10, 10))
    assert [p.kind for p in curve.points] == ["cusp"]
    assert curve.points[0].values == pytest.approx((4.5, 1.0), abs=1e-7)
    for amplitude, excitation in curve.values[::5]:
        expected = node_folds(excitation)
        assert min(abs(amplitude - s) for s in expected) < 1e-8
    ends = sorted(curve.values[[0, -1], 0])
    assert ends[0] < -3 and ends[1] > 3.8, "from one fold around the cusp to the other"


def test_the_folds_of_a_field_lie_on_one_line():
    branch = dd.continuation(line(), "s.amplitude", (0, 8), finer=False)
    up, down = (dd.locus(b, "u.kernel.0.amplitude", (3, 10), (0, 8)) for b in branch.bifurcations)
    assert up.points[-1].values == pytest.approx((4.62679, 4.16497), abs=1e-4)
    assert down.points[0].values == pytest.approx(up.points[-1].values, abs=1e-7)
    middle = down.values[np.argmin(np.abs(down.values[:, 1] - 6))]
    model = line(excitation=float(middle[1]))
    bifurcations = dd.continuation(model, "s.amplitude", (0, 8), finer=False).bifurcations
    assert min(abs(b.value - middle[0]) for b in bifurcations) < 1e-6


def test_a_fold_meets_a_hopf_point_where_0_is_a_double_growth_rate():
    model = oscillator()
    model.set("e.kernel.0.amplitude", 6.0)
    fold = dd.continuation(model, "e.resting_level", (-4, 6)).bifurcations[0]
    curve = dd.locus(fold, "back.factor", (-12, 0), (-10, 15))
    doubles = [p for p in curve.points if p.kind == "Bogdanov-Takens"]
    assert len(doubles) == 2
    level, factor = doubles[0].values
    model.set("back.factor", factor)
    bifurcations = dd.continuation(model, "e.resting_level", (-4, 6), finer=False).bifurcations
    nearest = min(bifurcations, key=lambda b: abs(b.value - level))
    assert nearest.value == pytest.approx(level, abs=1e-6)
    d = nearest.line.right_hand_side
    jacobian = d.linear(nearest.state, np.array([nearest.value]))[1] / d.time_constants[:, None]
    assert np.trace(jacobian) == pytest.approx(0, abs=1e-6), "both growth rates are 0"


def test_the_branch_point_of_a_selection_is_followed():
    point = dd.continuation(rivals(101), "u.global_inhibition", (0.3, 0.5), finer=False).bifurcations[-1]
    curve = dd.locus(point, "u.kernel.0.amplitude", (11, 13), (0, 1))
    assert curve.of == "branch point (selection)" and curve.points == ()
    assert curve.values[:, 1].min() <= 11 and curve.values[:, 1].max() >= 13
    inhibition, excitation = curve.values[-1]
    model = rivals(101)
    model.set("u.kernel.0.amplitude", float(excitation))
    bifurcations = dd.continuation(model, "u.global_inhibition", (0.25, 0.5), finer=False).bifurcations
    assert min(abs(b.value - inhibition) for b in bifurcations) < 1e-6


def test_what_cannot_be_followed_is_said():
    large = dd.continuation(plane(), "s.amplitude", (0, 6), finer=False).bifurcations[0]
    with pytest.raises(AnalysisError, match=r"has 900 states, .* at most 600"):
        dd.locus(large, "u.tau", (10, 30))
    fold = dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations[0]
    for parameter, span, message in (
        ("s.amplitude", (0, 1), "is the first parameter"),
        ("u.resting_level", (1, 1), "two different, finite numbers"),
        ("u.quadrature", (0, 1), "makes another program"),
    ):
        with pytest.raises(ParameterError, match=message):
            dd.locus(fold, parameter, span)


def test_the_figure_has_a_line_for_each_locus_and_each_point_once():
    branch = dd.continuation(node(), "s.amplitude", (0, 8))
    loci = [dd.locus(b, "u.kernel.0.amplitude", (0.5, 8), (-5, 8)) for b in branch.bifurcations]
    axes = dd.locus_figure(*loci, at=(2.0, 6.0)).axes[0]
    assert [drawn.get_marker() for drawn in axes.lines] == ["None", "^", "None", "+"]
    assert axes.get_xlabel() == "s.amplitude" and axes.get_ylabel() == "u.kernel.0.amplitude"
    curve = dd.locus(branch.bifurcations[0], "u.resting_level", (-6, -4), (-5, 8))
    with pytest.raises(FigureError, match="different parameters"):
        dd.locus_figure(loci[0], curve)
    with pytest.raises(FigureError, match="no locus"):
        dd.locus_figure()
    assert loci[0].data()["parameters"] == ["s.amplitude", "u.kernel.0.amplitude"]


def test_the_nearest_point_of_a_line_is_that_of_a_search():
    rng = np.random.default_rng(0)
    for _ in range(20):
        corners, at = rng.standard_normal((6, 2)), rng.standard_normal(2)
        shares = np.linspace(0, 1, 4001)[:, None]
        dense = np.concatenate([a + shares * (b - a) for a, b in pairwise(corners)])
        distance, place = nearest(corners, at)
        assert distance == pytest.approx(np.abs(dense - at).max(axis=1).min(), abs=2e-3)
        assert np.abs(place - at).max() == pytest.approx(distance)
        assert np.abs(dense - place).max(axis=1).min() < 2e-3, "it lies on the line"
    assert nearest(np.array([[1.0, 2.0]]), np.array([0.0, 4.0]))[0] == 2.0
    assert nearest(np.array([[0.0, 1.0], [0.0, 1.0]]), np.zeros(2))[0] == 1.0


def test_no_change_below_the_distance_reaches_the_line_and_the_distance_does():
    """The folds of a node are s = u - h - w g(u), so that the sides of the square may be sampled."""
    fold = dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations[0]
    curve = dd.locus(fold, "u.kernel.0.amplitude", (0.5, 10), (-10, 10))
    at = (2.0, 6.0)
    distance = curve.distance(at)
    s, w = curve.nearest(at)
    assert max(abs(s / 2 - 1), abs(w / 6 - 1)) == pytest.approx(distance)
    assert min(abs(s - fold) for fold in node_folds(w)) < 1e-3

    def crossed(share: float) -> bool:
        excitations = 6.0 * (1 + share * np.linspace(-1, 1, 201))
        return any(abs(fold / 2 - 1) < share for w in excitations for fold in node_folds(w))

    assert not crossed(0.995 * distance) and crossed(1.005 * distance)
    assert curve.distance(at, unit=(1, 1)) > distance
    turned = curve.over("u.kernel.0.amplitude", "s.amplitude")
    assert turned.distance((6.0, 2.0)) == pytest.approx(distance)
    assert turned.points[0].values == curve.points[0].values[::-1]
    assert curve.over(*curve.parameters) is curve


def test_a_distance_that_is_relative_to_nothing_is_refused():
    curve = Locus("fold", ("s.amplitude", "u.resting_level"), np.array([[1.0, -5.0], [2.0, -6.0]]))
    with pytest.raises(ParameterError, match=r"a change of s\.amplitude is relative to 0"):
        curve.distance((0, -5))
    assert curve.distance((0, -5), unit=(1, 1)) == 1.0
    with pytest.raises(ParameterError, match=r"at is .*expected two numbers"):
        curve.nearest((1, 2, 3))
    with pytest.raises(ParameterError, match=r"not over s\.amplitude and u\.tau"):
        curve.over("s.amplitude", "u.tau")


def test_other_parameters_of_the_branch_keep_their_values():
    """A node on a line of two parameters: the one that is not followed stays as it was on the line."""
    two_parameters = right_hand_side(node(), ["s.amplitude", "u.kernel.0.amplitude"])
    values = np.array([0.0, 8.0])
    line = ParameterLine(two_parameters, 0, values, 0.8)
    begin = begun(line, two_parameters.settle(two_parameters.start, values, 200), 0.0, 1.0)
    fold = walk(line, begin, (-4, 8), 400).bifurcations[0]
    curve = dd.locus(fold, "u.resting_level", (-6, -4), (-4, 12))
    for s, level in curve.values:
        assert s == pytest.approx(max(node_folds(8.0)) - (level + 5), abs=1e-7)
    second = dd.locus(fold, "u.kernel.0.amplitude", (7, 9), (-4, 12))
    assert second.values[:, 1].min() < 7 and second.values[:, 1].max() > 9
    for s, excitation in second.values:
        assert s == pytest.approx(max(node_folds(excitation)), abs=1e-7)


def test_a_figure_turns_lines_whose_parameters_are_in_the_other_order():
    points = np.array([[1.0, -5.0], [2.0, -6.0]])
    first = Locus("fold", ("s.amplitude", "u.resting_level"), points)
    second = Locus("fold", ("u.resting_level", "s.amplitude"), points[:, ::-1])
    axes = dd.locus_figure(first, second, at=(1.0, -4.0)).axes[0]
    a, b, _ = axes.lines
    assert (np.array(a.get_data()) == np.array(b.get_data())).all()
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts[-1] == "the model, 25.0% from\nfold"
    plain = dd.locus_figure(first, at=(0.0, -4.0)).axes[0].get_legend().get_texts()
    assert plain[-1].get_text() == "the model"
