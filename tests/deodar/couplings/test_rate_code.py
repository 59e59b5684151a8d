"""From numbers to peaks and back: exact if the samples contain the whole peak."""

from __future__ import annotations

import math

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.positions import PeakPosition, RateCode, SpaceCode
from deodar.elements.changing_stimuli import TimeSeries
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ParameterError

X, Y = dd.Axis("x", -20, 100, 121, unit="cm"), dd.Axis("y", 0, 50, 126, unit="cm")
RING = dd.Axis("phi", -180, 180, 36, periodic=True, unit="deg")
PAIR = dd.Axis("of", 0, 1, 2)


def back(axes, sigma, rates, **values):
    """Return the decoded numbers of a sequence that changes from step to step."""
    model = dd.Model("there and back", dt=1.0)
    rates = np.asarray(rates)
    source = model.add(TimeSeries("rates", [PAIR] if rates.ndim == 2 else [], np.arange(len(rates)), rates))
    code = {k: v for k, v in values.items() if k in ("gain", "offset")}
    (
        source
        >> model.add(SpaceCode(axes, sigma, 2.5, name="place", **code))
        >> model.add(RateCode(axes, name="rate", **values))
    )
    record = dd.simulate(model, len(rates) - 1, record=["rate.output", "rate.strength"], precision="float64")
    return record["rate.output"].values, record["rate.strength"].values


def test_the_rate_is_the_position_of_a_peak_on_a_line():
    rates = np.random.default_rng(0).uniform(0.1, 0.9, 50)
    position, strength = back([X], 3.0, rates, gain=80.0, offset=2.5)
    np.testing.assert_allclose(position, rates, atol=1e-9)
    np.testing.assert_allclose(strength, 2.5 * 3.0 * math.sqrt(2 * math.pi), rtol=1e-6)


def test_the_rates_are_the_position_of_a_peak_in_a_plane():
    rates = np.random.default_rng(1).uniform(-1, 1, (50, 2))
    position, _ = back([X, Y], (4.0, 2.0), rates, gain=(-30.0, 10.0), offset=(40.0, 25.0))
    np.testing.assert_allclose(position, rates, atol=1e-6)


@pytest.mark.parametrize("sigma", [10.0, 20.0, 30.0])
def test_the_rate_is_the_direction_of_a_peak_on_a_ring(sigma):
    rates = np.random.default_rng(2).uniform(-math.pi, math.pi, 50)
    position, _ = back([RING], sigma, rates, gain=180 / math.pi)
    np.testing.assert_allclose(position, rates, atol=1e-6)
    turned, _ = back([RING], sigma, rates + 6 * math.pi, gain=180 / math.pi)
    np.testing.assert_allclose(turned, rates, atol=1e-6)


@pytest.mark.parametrize(("sigmas", "wrong"), [(6, 6.1e-9), (4, 1.4e-4), (2, 0.06)])
def test_truncation_moves_the_mean_inwards(sigmas, wrong):
    """The mean of a truncated Gaussian is shifted by the density of the normal distribution at the end of
    the last cell.
    """
    sigma = 5.0
    end = sigmas + 0.5 * X.step / sigma
    position, _ = back([X], sigma, [X.lower + sigmas * sigma] * 2)
    error = (position[0] - X.lower) / sigma - sigmas
    assert 0 < error < wrong
    assert error == pytest.approx(math.exp(-(end**2) / 2) / math.sqrt(2 * math.pi), rel=0.1)


def test_a_space_code_of_the_rates_restores_the_peak():
    model = dd.Model("peak")
    peak = model.add(dd.GaussianStimulus("peak", [X, RING], center=[33.3, 171.0], sigma=[3, 20]))
    decoded = model.add(
        SpaceCode([X, RING], [3, 20], 1.0, gain=[5.0, 1.0], offset=[-7.0, 30.0], name="again")
    )
    peak >> model.add(RateCode([X, RING], [5.0, 1.0], [-7.0, 30.0], name="rate")) >> decoded
    record = dd.simulate(model, 1, dt=1.0, record=["peak.output", "again.output"], precision="float64")
    np.testing.assert_allclose(record["again.output"].values, record["peak.output"].values, atol=1e-6)


def test_on_one_axis_it_is_the_position_of_the_peak():
    model = dd.Model("position")
    u = model.add(dd.Field("u", [RING], noise=2.0, resting_level=-1))
    for read in (
        PeakPosition(RING, 0.5, 7.0, name="position"),
        RateCode([RING], least=0.5, absent=7.0, name="rate"),
    ):
        u >> model.add(read)
    record = dd.simulate(
        model,
        50,
        dt=1.0,
        record=["position", "rate", "position.strength", "rate.strength"],
        precision="float64",
    )
    np.testing.assert_allclose(record["rate.output"].values, record["position.output"].values, rtol=1e-12)
    np.testing.assert_allclose(record["rate.strength"].values, record["position.strength"].values, rtol=1e-12)


def test_without_a_peak_or_a_direction_the_rate_is_the_default():
    model = dd.Model("nothing")
    rows = {"silent": np.zeros((121, 36)), "even": np.ones((121, 36))}
    for name, values in rows.items():
        rate = RateCode([X, RING], 1.0, 0.0, 0.5, [-1.0, -2.0], name=f"rate of {name}")
        model.add(Pattern(name, [X, RING], values)) >> model.add(rate)
    record = dd.simulate(model, 1, dt=1.0, record=["rate of silent.output", "rate of even.output"])
    np.testing.assert_array_equal(record["rate of silent.output"].values[-1], [-1, -2])
    np.testing.assert_allclose(record["rate of even.output"].values[-1], [40, -2], atol=1e-4)


def test_a_rate_code_without_an_inverse_is_refused():
    with pytest.raises(ParameterError, match="gain: is 0"):
        RateCode([X], 0.0)
    with pytest.raises(ParameterError, match="axes: is empty"):
        RateCode([])
    model = dd.Model("live")
    model.add(Boost("s", [X], 1.0)) >> model.add(RateCode([X], name="rate"))
    with pytest.raises(ParameterError, match="gain: is 0"):
        dd.Session(model).set("rate.gain", 0.0)
