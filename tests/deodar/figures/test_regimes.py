"""Figures of regimes: hysteresis, patterns of a field, and phase plots of a node."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.phase import phase
from deodar.analysis.regimes import Regimes, regimes

X = dd.Axis("x", -10, 30, samples=41, unit="deg")


@pytest.fixture(scope="module")
def field() -> Regimes:
    return regimes(dd.Field("u", [X], tau=10, kernel=[dd.Gaussian(1.2, 4)], global_inhibition=0.6))


@pytest.fixture(scope="module")
def node() -> Regimes:
    return regimes(
        dd.Field("n", [], tau=10, resting_level=-2, sigmoid=dd.Logistic(4), kernel=[dd.Gaussian(3.0)])
    )


def curves(axes: Any) -> dict[str, np.ndarray]:
    return {line.get_label(): np.asarray(line.get_xydata()) for line in axes.get_lines()}


def test_the_patterns_of_a_field_fill_the_width_of_its_axis(field: Regimes) -> None:
    left, right = dd.regimes_figure(field).axes
    assert right.get_xlim() == (-10, 30) and right.get_xlabel() == "x (deg)"
    drawn = curves(right)
    assert np.array_equal(drawn["at rest"], np.column_stack([X.points, field.rest]))
    assert field.above is not None
    assert np.array_equal(drawn["just above detection"], np.column_stack([X.points, field.above]))
    low, high = right.get_ylim()
    assert low < field.rest.min() and high > field.above.max()
    ramp = field.ramp
    assert np.array_equal(curves(left)["input grows"], np.column_stack([ramp.values, ramp.up.activation]))
    marks = [text.get_text() for text in left.texts]
    assert marks == [f"detection\n{field.detection:.3g}", f"reverse detection\n{field.reverse:.3g}"]


def test_a_node_has_a_phase_plot_at_every_threshold(node: Regimes) -> None:
    left, right = dd.regimes_figure(node).axes
    assert (left.get_xlabel(), right.get_xlabel()) == ("input", "activation u")
    labels = set(curves(right))
    assert {
        "no input",
        f"at detection, input {node.detection:.3g}",
        f"at reverse detection, input {node.reverse:.3g}",
    } <= labels
    fixed = [
        line for line in right.get_lines() if line.get_marker() == "o" and np.size(line.get_xdata()) == 1
    ]
    stable = [float(line.get_xdata()[0]) for line in fixed if line.get_markerfacecolor() != "white"]  # type: ignore[arg-type]
    inputs = (0.0, node.detection, node.reverse)
    points = [p for s in inputs for p in phase(node.isolated.field, s).fixed_points]  # type: ignore[arg-type]
    assert len(fixed) == len(points) > 4
    assert sorted(stable) == pytest.approx(sorted(p.u for p in points if p.stable))
