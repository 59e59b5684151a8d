"""The distribution of population activity against known sums of Gaussians."""

from __future__ import annotations

import math

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.population_activity import PopulationActivity
from deodar.couplings.positions import RateCode
from deodar.elements.stimuli import Pattern
from deodar.errors import ModelError, ParameterError

X, Y = dd.Axis("x", 0, 90, 181, unit="deg"), dd.Axis("y", 0, 10, 11)
RING = dd.Axis("phi", 0, 360, 72, periodic=True, unit="deg")


def activities(rates, population, read=None):
    model = dd.Model("population")
    neurons = dd.Axis("neuron", 0, len(rates) - 1, len(rates))
    activity = model.add(population)
    model.add(Pattern("rates", [neurons], rates)) >> activity
    if read is not None:
        activity >> model.add(read)
    name = population.name if read is None else read.name
    return dd.simulate(model, 1, dt=1.0, record=f"{name}.output", precision="float64")[
        f"{name}.output"
    ].values[-1]


def test_tuning_curves_weighted_by_rates():
    rng = np.random.default_rng(0)
    tuning, rates = rng.random((5, 181)), rng.random(5)
    y = activities(rates, PopulationActivity(tuning, [X], -2.0, name="p"))
    np.testing.assert_allclose(y, -2 * sum(r * t for r, t in zip(rates, tuning, strict=True)), rtol=1e-12)
    mean = activities(rates, PopulationActivity(tuning, [X], normalized=True, name="p"))
    np.testing.assert_allclose(mean, rates @ tuning / tuning.sum(0), rtol=1e-12)


def test_equal_tuning_curves_give_a_wider_gaussian_at_the_stimulus():
    """For rates and tuning curves of width s, the sum over neurons at distances d is a Gaussian of width s
    root 2 and height s root pi / d.
    """
    preferred, sigma, stimulus = np.arange(-60, 151, 3.0), 6.0, 41.7
    rates = 20 * np.exp(-0.5 * ((preferred - stimulus) / sigma) ** 2)
    y = activities(rates, PopulationActivity.of(preferred, sigma, [X], name="p"))
    height = 20 * sigma * math.sqrt(math.pi) / 3
    np.testing.assert_allclose(
        y, height * np.exp(-0.25 * ((X.points - stimulus) / sigma) ** 2), atol=1e-6 * height
    )


def test_on_a_ring_the_population_vector_finds_the_direction():
    preferred = np.arange(0, 360, 10.0)
    for stimulus in (3.0, 181.4, 357.9):
        distance = preferred - stimulus - 360 * np.round((preferred - stimulus) / 360)
        rates = np.exp(-0.5 * (distance / 20) ** 2)
        read = activities(
            rates, PopulationActivity.of(preferred, 20, [RING], name="p"), RateCode([RING], name="rate")
        )
        assert read == pytest.approx(stimulus, abs=1e-6)


def test_unevenly_spaced_neurons_have_equal_weight_if_normalized():
    preferred = np.concatenate([np.arange(0, 45, 1.0), np.arange(45, 95, 10.0)])
    y = activities(
        np.full(len(preferred), 7.0), PopulationActivity.of(preferred, 8, [X], normalized=True, name="p")
    )
    np.testing.assert_allclose(y, 7.0, rtol=1e-12)
    y = activities(np.array([7.0, 3.0]), PopulationActivity(np.eye(2, 181), [X], normalized=True, name="p"))
    np.testing.assert_array_equal(y, [7.0, 3.0, *np.zeros(179)])


def test_activity_over_a_plane_is_the_weighted_sum_of_tuning_curves():
    preferred = [[10.0, 2.0], [60.0, 7.0]]
    y = activities(
        np.array([1.0, 3.0]), PopulationActivity.of(preferred, [5.0, 1.5], [X, Y], rate=2.0, name="p")
    )
    bumps = [
        np.exp(-0.5 * ((X.points[:, None] - a) / 5) ** 2 - 0.5 * ((Y.points[None] - b) / 1.5) ** 2)
        for a, b in preferred
    ]
    np.testing.assert_allclose(y, 2 * bumps[0] + 6 * bumps[1], rtol=1e-12)


def test_wrong_tuning_curves_are_reported():
    with pytest.raises(ParameterError, match=r"tuning: has shape \[3, 4\]"):
        PopulationActivity(np.ones((3, 4)), [X])
    with pytest.raises(ParameterError, match="one value for each of 2 axes"):
        PopulationActivity.of([1.0, 2.0], 5, [X, Y])
    model = dd.Model("few")
    rates = model.add(Pattern("rates", [dd.Axis("neuron", 0, 1, 2)], [1.0, 2.0]))
    rates >> model.add(PopulationActivity.of([10, 20, 30], 5, [X], name="p"))
    with pytest.raises(ModelError, match="has the tuning of 3 neurons"):
        dd.Session(model)
