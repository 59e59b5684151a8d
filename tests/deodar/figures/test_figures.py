"""Figures from Python: their content, their labels, and their errors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import RecordError
from deodar.figures import projection, snapshot, snapshots, space_time, time_course
from deodar.figures._color import scale
from deodar.figures._panels import choose
from deodar.figures._style import PANEL, SINGLE
from deodar.figures._view import View
from tests.deodar.recording.models import record, x


@pytest.fixture(scope="module")
def recorded() -> xarray.Dataset:
    return record(trials=3, sweep={"s.amplitude": [4.0, 8.0]})


def labels(figure: Any) -> set[str]:
    every = [part for axes in figure.axes for part in (axes, *axes.child_axes)]  # colour bars are inside
    return {text for axes in every for text in (axes.get_xlabel(), axes.get_ylabel()) if text}


def images(figure: Any) -> list[np.ndarray]:
    return [np.asarray(image.get_array()) for axes in figure.axes for image in axes.get_images()]


def test_a_space_time_plot_shows_the_values_with_units(recorded: xarray.Dataset) -> None:
    trial = recorded["u.activation"].sel({"s.amplitude": 8.0, "trial": 1})
    figure = space_time(trial)
    (image,) = images(figure)
    assert np.allclose(image, trial.values.T)
    # each column lies around its time
    times = trial["time"].values
    half = (times[1] - times[0]) / 2
    (drawn,) = figure.axes[0].get_images()
    assert drawn.get_extent()[:2] == pytest.approx([times[0] - half, times[-1] + half])
    assert {"time (ms)", "x (deg)"} <= labels(figure) and any(
        "activation of u" in text for text in labels(figure)
    )


def test_a_time_course_draws_each_trial_and_their_mean(recorded: xarray.Dataset) -> None:
    trials = recorded["n.activation"].sel({"s.amplitude": 4.0})
    (axes,) = time_course(trials).axes
    curves = [
        np.asarray(line.get_ydata())
        for line in axes.get_lines()
        if len(np.asarray(line.get_xdata())) == trials.sizes["time"]
    ]
    for trial in range(3):
        assert any(np.allclose(c, trials.isel(trial=trial).values) for c in curves)
    assert any(np.allclose(c, trials.mean("trial").values, atol=1e-6) for c in curves)


def test_snapshots_share_their_scale(recorded: xarray.Dataset) -> None:
    trial = recorded["u.activation"].isel({"s.amplitude": 1, "trial": 0})
    figure = snapshots(trial, at=[0, 10, 20])
    limits = {tuple(axes.get_ylim()) for axes in figure.axes if axes.get_lines()}
    assert len(limits) == 1 and len(figure.axes) >= 3
    single = snapshot(trial, at=[20])
    drawn = [np.asarray(line.get_ydata()) for axes in single.axes for line in axes.get_lines()]
    assert any(len(c) == 11 and np.allclose(c, trial.values[-1]) for c in drawn)


def test_a_projection_takes_the_largest_value_along_the_other_axes() -> None:
    model = dd.Model("deep")
    model.add(dd.Field("w", [x, dd.Axis("y", 0, 10, samples=6), dd.Axis("z", 0, 4, samples=5)], noise=0.5))
    u = dd.simulate(model, 10)["w.activation"]
    (image,) = images(projection(u, axes=["x", "y"]))
    assert np.allclose(image, u.values[0].max(axis=2).T)
    (total,) = images(projection(u, axes=["x", "z"], reduce="integral"))
    assert np.allclose(total, u.values[0].sum(axis=1).T * 2.0, rtol=1e-5)


def test_the_title_of_a_projection_states_its_time() -> None:
    model = dd.Model("deep")
    model.add(dd.Field("w", [x, dd.Axis("y", 0, 10, samples=6), dd.Axis("z", 0, 4, samples=5)], noise=0.5))
    u = dd.simulate(model, 10, record="w.activation", every=5)["w.activation"]
    projected = projection(u, axes=["x", "y"], at=[5])
    assert projected.axes[0].get_title() == "5 ms" and not projected.get_suptitle()
    every_pair = projection(u, at=[10])
    assert every_pair.get_suptitle() == "10 ms" and not any(axes.get_title() for axes in every_pair.axes)
    for axes in ([], ["x", "x"], ["x", "y", "z"]):
        with pytest.raises(dd.errors.RecordError, match="goes onto one axis or two"):
            projection(u, axes=axes)


@pytest.mark.parametrize(
    ("dims", "options", "kind"),
    [
        (0, {}, "time_course"),
        (1, {}, "space_time"),
        (2, {}, "snapshots"),
        (3, {}, "projection"),
        (0, {"at": [5]}, "snapshot"),
        (1, {"at": [5]}, "snapshot"),
        (1, {"at": [5, 10]}, "snapshots"),
        (2, {"at": [5]}, "snapshot"),
        (3, {"at": [5]}, "projection"),
        (2, {"axes": ["a"]}, "projection"),
        (3, {"places": [[1, 1, 1]]}, "time_course"),
    ],
)
def test_the_default_kind_suits_the_dimensions_and_the_request(
    dims: int, options: dict[str, Any], kind: str
) -> None:
    values = np.zeros((3, *[4] * dims))
    variable = xarray.DataArray(values, dims=["time", *"abc"[:dims]], coords={"time": [0.0, 5.0, 10.0]})
    assert choose(View(variable, **options)) == kind


@pytest.mark.parametrize("kind", [space_time, time_course])
def test_a_panel_fills_one_column_and_is_wider_than_high(recorded: xarray.Dataset, kind: Any) -> None:
    width, height = kind(recorded["u.activation"].isel({"s.amplitude": 1, "trial": 0})).get_size_inches()
    assert width == SINGLE and height == pytest.approx(PANEL, abs=0.25)


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
        (time_course, {"places": [[10.0, 5.0]]}, "has 1 numbers .x., not 2"),
        (snapshot, {"at": [999.0]}, "999"),
        (projection, {"axes": ["q"]}, "q"),
    ],
)
def test_a_time_or_trial_that_was_not_recorded_is_refused(
    recorded: xarray.Dataset, kind: Any, options: dict[str, Any], says: str
) -> None:
    with pytest.raises(dd.errors.RecordError, match=says):
        kind(recorded["u.activation"], **options)


def test_times_along_another_dimension_are_refused() -> None:
    variable = xarray.DataArray(
        np.zeros(4), {"time": ("place", np.arange(4.0))}, "place", name="u.activation"
    )
    with pytest.raises(RecordError, match=r"u\.activation: has times along place"):
        View(variable)


@pytest.mark.parametrize("times", [["a", "b", "c"], [0.0, np.nan, 2.0]], ids=["text", "not a number"])
def test_times_that_are_no_numbers_are_refused(times: list[Any]) -> None:
    variable = xarray.DataArray(np.zeros(3), {"time": times}, "time", name="u.activation")
    with pytest.raises(RecordError, match=r"u\.activation: has values of time that are no finite numbers"):
        View(variable, time_range=(0, 2))
    places = xarray.DataArray(np.zeros(3), {"x": ("x", times, {"lower": 0})}, "x", name="u.activation")
    with pytest.raises(RecordError, match=r"u\.activation: has values of x that are no finite numbers"):
        View(places).extent("x")
