"""A Gaussian that moves: its position at every step, on lines, rings and planes."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.changing_stimuli import MovingGaussian
from deodar.errors import ParameterError
from deodar.model import document_files
from tests.contracts.timed import alone
from tests.deodar.elements.chunks import require_the_same_in_any_chunks

X, Y = dd.Axis("x", 0, 30, 31), dd.Axis("y", -5, 5, 21)
RING = dd.Axis("phi", 0, 360, 36, periodic=True)


def seen(duration=40.0, dt=0.5, precision="float64", **values):
    model = dd.Model("stimulus", dt=dt)
    model.add(MovingGaussian("s", **values))
    record = dd.simulate(model, duration, record=["s.output"], precision=precision)["s.output"]
    return record["time"].values, record.values


def plain(axis, places, sigma):
    d = axis.points - np.asarray(places)[:, None]
    if axis.periodic:
        d = d - axis.range * np.round(d / axis.range)
    return np.exp(-0.5 * (d / sigma) ** 2)


def test_a_stimulus_moves_at_constant_velocity_in_a_plane():
    t, y = seen(axes=[X, Y], center=[2, 4], sigma=[3, 1], amplitude=2.5, velocity=[0.6, -0.25])
    np.testing.assert_allclose(
        y, 2.5 * plain(X, 2 + 0.6 * t, 3)[:, :, None] * plain(Y, 4 - 0.25 * t, 1)[:, None, :], atol=1e-12
    )


def test_a_moving_stimulus_crosses_the_ends_of_a_periodic_axis():
    t, y = seen(axes=[RING], center=300, sigma=25, velocity=9.0, duration=100.0)
    np.testing.assert_allclose(y, plain(RING, 300 + 9 * t, 25), atol=1e-12)
    assert (RING.points[y.argmax(1)][[0, 10, 80]] == [300, 340, 300]).all()


def test_the_position_is_constant_before_the_first_and_after_the_last_waypoint():
    waypoints = [[5, 3.0], [15, 23.0], [20, 10.0]]
    t, y = seen(axes=[X], sigma=2, waypoints=waypoints)
    np.testing.assert_allclose(y, plain(X, np.interp(t, [5, 15, 20], [3, 23, 10]), 2), atol=1e-12)
    assert (y[t <= 5] == y[0]).all() and (y[t >= 20] == y[-1]).all()


def test_path_and_velocity_and_centre_add_up():
    waypoints = [[0, 0.0, 0.0], [30, 6.0, -2.0]]
    t, y = seen(axes=[X, Y], center=[5, 1], sigma=2, velocity=[0.1, 0.05], waypoints=waypoints)
    share = np.minimum(t / 30, 1)
    np.testing.assert_allclose(
        y,
        plain(X, 5 + 0.1 * t + 6 * share, 2)[:, :, None] * plain(Y, 1 + 0.05 * t - 2 * share, 2)[:, None, :],
        atol=1e-12,
    )


def test_a_moving_stimulus_without_motion_equals_the_gaussian_stimulus():
    _, y = seen(axes=[X], center=12, sigma=4, amplitude=3, windows=[(10, 20)])
    model = dd.Model("stands", dt=0.5)
    model.add(dd.GaussianStimulus("s", [X], center=12, sigma=4, amplitude=3, windows=[(10, 20)]))
    np.testing.assert_array_equal(
        y, dd.simulate(model, 40, record=["s.output"], precision="float64")["s.output"].values
    )


def test_how_a_run_is_cut_into_chunks_changes_no_bit():
    element = MovingGaussian("s", [X], velocity=0.3, waypoints=[[2, 0], [9, 7]])
    require_the_same_in_any_chunks(element)


def test_a_document_keeps_the_waypoints(tmp_path):
    model = dd.Model("moving")
    model.add(MovingGaussian("s", [X], waypoints=[[0, 1], [10, 5]]))
    model.add(MovingGaussian("t", [X], velocity=0.5))
    dd.save(model, tmp_path / "moving.json")
    assert dd.load(tmp_path / "moving.json").document == model.document


def test_a_document_of_version_2_names_the_waypoints_path():
    model = dd.Model("moving")
    model.add(MovingGaussian("s", [X], waypoints=[[0, 1], [10, 5]]))
    document, arrays = document_files.to_data(model.document)
    body = {
        "path" if key == "waypoints" else key: content for key, content in document["elements"]["s"].items()
    }
    assert "path" in body
    for version in (1, 2):
        assert (
            document_files.from_data({**document, "deodar": version, "elements": {"s": body}}, arrays)
            == model.document
        )


@pytest.mark.parametrize(
    ("waypoints", "problem"),
    [
        ([[0, 1, 2]], "rows of 2 numbers"),
        ([1.0, 2.0], "rows of 2 numbers"),
        ([[0, 1], [0, 2]], "goes back in time"),
        ([[5, 1], [0, 2]], "back in"),
    ],
)
def test_waypoints_of_another_shape_are_refused(waypoints, problem):
    with pytest.raises(ParameterError, match=problem):
        MovingGaussian("s", [X], waypoints=waypoints)


def timed(t0: float) -> dd.Model:
    points = [[t0, 0.0], [t0 + 6, 60.0]]
    return alone(
        MovingGaussian("example", [RING], center=20.0, sigma=30.0, velocity=0.1, waypoints=points), t0
    )
