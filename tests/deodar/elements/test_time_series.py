"""Input over time: linear or stepwise between given times, once or periodic."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.changing_stimuli import TimeSeries
from deodar.errors import ModelError, ParameterError
from tests.contracts.timed import alone
from tests.deodar.elements.chunks import require_the_same_in_any_chunks

X, Y = dd.Axis("x", 0, 4, 5), dd.Axis("y", 0, 2, 3)
TIMES = [2.0, 5.0, 6.0, 10.0]
VALUES = np.random.default_rng(1).normal(size=(4, 5, 3))


def seen(duration=24.0, dt=0.5, precision="float64", t0=0.0, **values):
    model = dd.Model("series", dt=dt)
    model.describe(t0=t0)
    model.add(TimeSeries("s", **({"axes": [X, Y], "times": TIMES, "values": VALUES} | values)))
    record = dd.simulate(model, duration, record=["s.output"], precision=precision)["s.output"]
    return record["time"].values, record.values


def lines(t):
    flat = VALUES.reshape(4, -1)
    return np.stack([np.interp(t, TIMES, column) for column in flat.T], axis=1).reshape(len(t), 5, 3)


def test_values_between_times_are_interpolated_linearly():
    t, y = seen(amplitude=-2.0)
    np.testing.assert_allclose(y, -2 * lines(t), atol=1e-12)


def test_a_held_value_lasts_until_the_next_sample():
    t, y = seen(interpolation="hold")
    which = np.maximum(np.searchsorted(TIMES, t, side="right") - 1, 0)
    np.testing.assert_array_equal(y, VALUES[which])


@pytest.mark.parametrize("interpolation", ["linear", "hold"])
@pytest.mark.parametrize("dt", [0.5, 0.1])
def test_a_series_with_a_period_repeats(interpolation, dt):
    t, once = seen(11.5 if dt == 0.5 else 11.9, dt=dt, interpolation=interpolation, period=12.0)
    _, often = seen(60.0, dt=dt, interpolation=interpolation, period=12.0)
    for k in range(5):
        part = often[k * len(t) :][: len(t)]
        np.testing.assert_allclose(part, once, atol=1e-9)


def test_a_periodic_series_is_exact_after_a_day():
    """Single precision alone cannot count milliseconds for a day."""
    day = 86_400_000.0
    _, early = seen(30.0, precision="float32", interpolation="hold", period=12.0)
    _, late = seen(30.0, precision="float32", interpolation="hold", period=12.0, t0=day)
    np.testing.assert_array_equal(early, late)


def test_series_of_numbers_and_series_of_a_single_time_are_accepted():
    t, y = seen(axes=[], times=[1.0, 3.0], values=[0.0, 4.0], windows=[(2, 20)])
    np.testing.assert_allclose(y, np.where((t >= 2) & (t < 20), np.clip(2 * (t - 1), 0, 4), 0), atol=1e-12)
    _, y = seen(axes=[X], times=[7.0], values=[np.arange(5.0)])
    assert (y == np.arange(5.0)).all()


@pytest.mark.parametrize("period", [0.0, 7.3])
def test_how_a_run_is_cut_into_chunks_changes_no_bit(period):
    element = TimeSeries("s", [X, Y], TIMES, VALUES, period=period)
    require_the_same_in_any_chunks(element)


def test_a_series_is_created_from_a_function():
    series = TimeSeries.of("s", lambda t, x, y: t * x - y, range(4), [X, Y], interpolation="hold")
    t = np.arange(4.0)[:, None, None]
    np.testing.assert_array_equal(series.values.data, t * X.points[:, None] - Y.points)
    np.testing.assert_array_equal(series.times.data, [0, 1, 2, 3])
    assert TimeSeries.of("s", lambda t: 1.0, [0, 1], []).values.data.tolist() == [1, 1]


def test_wrong_times_and_values_are_reported():
    with pytest.raises(ParameterError, match="times: does not rise"):
        TimeSeries("s", [], [0.0, 0.0], [1.0, 2.0])
    with pytest.raises(ParameterError, match="times: has shape"):
        TimeSeries("s", [], [[0.0, 1.0]], [1.0, 2.0])
    with pytest.raises(ParameterError, match="interpolation: is 'cubic'"):
        TimeSeries("s", [], [0.0], [1.0], interpolation="cubic")
    model = dd.Model("shape")
    model.add(TimeSeries("s", [X], [0.0, 1.0], VALUES[:, :, 0]))
    with pytest.raises(
        ModelError, match=r"values has shape \[4, 5\], its times and axes have \[2, 5\] samples"
    ):
        dd.Session(model)


def timed(t0: float) -> dd.Model:
    times = t0 + np.array([1.0, 3.0, 3.5, 6.0])
    return alone(TimeSeries("example", [], times, [1.0, 2.0, -3.0, 5.0]), t0)


def lasting(duration: float) -> dd.Model:
    return alone(TimeSeries("example", [], [0.0, 1.0], [5.0, -1.0], interpolation="hold", period=duration))
