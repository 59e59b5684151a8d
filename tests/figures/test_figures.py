"""Figures from Python: their content, their labels, and their errors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.figures import projection, snapshot, snapshots, space_time, time_course
from deodar.figures._color import scale
from tests.recording.models import record, x


@pytest.fixture(scope="module")
def data() -> xarray.Dataset:
    return record(trials=3, sweep={"s.amplitude": [4.0, 8.0]})


def labels(figure: Any) -> set[str]:
    return {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}


def images(figure: Any) -> list[np.ndarray]:
    return [np.asarray(image.get_array()) for axes in figure.axes for image in axes.get_images()]


def test_a_space_time_plot_shows_the_values_with_units(data: xarray.Dataset) -> None:
    one = data["u.activation"].sel({"s.amplitude": 8.0, "trial": 1})
    figure = space_time(one)
    (shown,) = images(figure)
    assert np.allclose(shown, one.values.T)
    assert {"time (ms)", "x (deg)"} <= labels(figure) and any(
        "activation of u" in text for text in labels(figure)
    )


def test_a_time_course_draws_each_trial_and_their_mean(data: xarray.Dataset) -> None:
    one = data["n.activation"].sel({"s.amplitude": 4.0})
    (axes,) = time_course(one).axes
    curves = [
        np.asarray(line.get_ydata())
        for line in axes.get_lines()
        if len(np.asarray(line.get_xdata())) == one.sizes["time"]
    ]
    for trial in range(3):
        assert any(np.allclose(c, one.isel(trial=trial).values) for c in curves)
    assert any(np.allclose(c, one.mean("trial").values, atol=1e-6) for c in curves)


def test_snapshots_share_their_scale(data: xarray.Dataset) -> None:
    one = data["u.activation"].isel({"s.amplitude": 1, "trial": 0})
    figure = snapshots(one, at=[0, 10, 20])
    limits = {tuple(axes.get_ylim()) for axes in figure.axes if axes.get_lines()}
    assert len(limits) == 1 and len(figure.axes) >= 3
    single = snapshot(one, at=[20])
    drawn = [np.asarray(line.get_ydata()) for axes in single.axes for line in axes.get_lines()]
    assert any(len(c) == 11 and np.allclose(c, one.values[-1]) for c in drawn)


def test_a_projection_takes_the_largest_value_along_the_other_axes() -> None:
    model = dd.Model("deep")
    model.add(dd.Field("w", [x, dd.Axis("y", 0, 10, samples=6), dd.Axis("z", 0, 4, samples=5)], noise=0.5))
    u = dd.simulate(model, 10)["w.activation"]
    (shown,) = images(projection(u, axes=["x", "y"]))
    assert np.allclose(shown, u.values[0].max(axis=2).T)
    (total,) = images(projection(u, axes=["x", "z"], reduce="integral"))
    assert np.allclose(total, u.values[0].sum(axis=1).T * 2.0, rtol=1e-5)


def test_the_range_of_colours_contains_the_threshold() -> None:
    """The noise of a silent field must not look like peaks."""
    silent = np.random.default_rng(1).normal(-5, 0.02, (20, 20))
    low, high = scale([silent], 0.0).get_clim()
    assert low == pytest.approx(silent.min()) and high == 0.0
    assert scale([np.array([1.0, 2.0])], None).get_clim() == (1.0, 2.0)


@pytest.mark.parametrize(
    ("kind", "options", "says"),
    [
        (time_course, {"where": {"s.amplitude": 5.0}}, "Valid values: 4, 8"),
        (time_course, {"places": [1000.0]}, "outside"),
        (snapshot, {"at": [999.0]}, "999"),
        (projection, {"axes": ["q"]}, "q"),
    ],
)
def test_a_time_or_trial_that_was_not_recorded_is_refused(
    data: xarray.Dataset, kind: Any, options: dict[str, Any], says: str
) -> None:
    with pytest.raises(dd.errors.RecordError, match=says):
        kind(data["u.activation"], **options)
