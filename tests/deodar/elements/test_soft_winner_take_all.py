"""Soft winner-take-all: its steps, its fixed points, and its equivalence to a field."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.changing_stimuli import Noise
from deodar.elements.populations import SoftWinnerTakeAll
from deodar.elements.stimuli import Pattern
from deodar.numerics.sigmoids import Linear

ITEMS = dd.Axis("item", 1, 6, 6)
EVIDENCE = np.array([1.0, 1.4, 0.2, 1.9, 1.7, 0.5])


def settled(evidence=EVIDENCE, duration=1500, **values):
    model = dd.Model("pool")
    pool = model.add(SoftWinnerTakeAll("pool", [ITEMS], **values))
    model.add(Pattern("evidence", [ITEMS], evidence)) >> pool
    record = dd.simulate(
        model, duration, record=["pool.output", "pool.inhibitory"], every=duration, precision="float64"
    )
    return record["pool.output"].values[-1], float(record["pool.inhibitory"].values[-1])


def test_the_steps_are_those_of_the_equations():
    x = dd.Axis("x", 0, 10, 21)
    kernel = dd.Gaussian(0.3, 1.5)
    model = dd.Model("steps", dt=0.5)
    pool = model.add(
        SoftWinnerTakeAll(
            "pool",
            [x],
            8.0,
            3.0,
            0.7,
            [kernel],
            1.1,
            0.4,
            0.25,
            0.15,
            sigmoid=dd.Logistic(2.0),
            sigmoid_inhibition=dd.Logistic(3.0),
        )
    )
    model.add(dd.GaussianStimulus("s", [x], center=4, sigma=2, amplitude=2)) >> pool
    record = dd.simulate(
        model, 40, record=["pool", "pool.inhibitory", "pool.interaction"], precision="float64"
    )
    s = 2 * np.exp(-0.5 * ((x.points - 4) / 2) ** 2)
    weights = 0.3 * np.exp(-0.5 * ((x.points[:, None] - x.points) / 1.5) ** 2) * x.step
    r, v = np.zeros(21), 0.0
    for k in range(81):
        lateral = 0.7 * r + weights @ r - 1.1 * v
        for port, expected in (("output", r), ("inhibitory", v), ("interaction", lateral)):
            np.testing.assert_allclose(record[f"pool.{port}"].values[k], expected, atol=1e-12)
        new = r + 0.5 / 8 * (-r + 1 / (1 + np.exp(-2 * (s + lateral - 0.25))))
        v = v + 0.5 / 3 * (-v + 1 / (1 + np.exp(-3 * (0.4 * x.step * r.sum() - 0.15))))
        r = new


def test_the_winner_is_amplified_and_the_others_are_silent():
    rates, v = settled()
    assert rates[3] == pytest.approx(1.9 / (1 + 3 * 0.25 - 1.2), abs=1e-6) and v == pytest.approx(
        0.25 * rates[3], abs=1e-6
    )
    assert np.delete(rates, 3).max() < 1e-6


def test_without_self_excitation_several_units_are_active():
    """Weak competition keeps several active: r = s - beta_1 beta_2 sum r, where this is above 0."""
    rates, v = settled(self_excitation=0.0, inhibition=0.8, drive=0.25)
    np.testing.assert_allclose(rates, np.maximum(0, EVIDENCE - 0.2 * rates.sum()), atol=1e-6)
    assert (rates > 1e-6).sum() == 4 and v == pytest.approx(0.25 * rates.sum(), abs=1e-6)


def test_inhibition_depends_on_the_units_and_not_on_the_grid_step():
    """The same pool with twice the samples: the integral over the axis drives the inhibition."""
    winners = []
    for samples in (51, 101):
        x = dd.Axis("x", 0, 100, samples)
        model = dd.Model("fine")
        pool = model.add(
            SoftWinnerTakeAll(
                "pool",
                [x],
                self_excitation=0.5,
                kernel=[dd.Gaussian(1, 4, normalized=True)],
                inhibition=0.5,
                drive=0.1,
            )
        )
        model.add(dd.GaussianStimulus("s", [x], center=50, sigma=8, amplitude=2)) >> pool
        winners.append(
            dd.simulate(model, 400, record=["pool"], every=400, precision="float64")["pool.output"].values[-1]
        )
    # the edge of what is active falls between samples
    np.testing.assert_allclose(winners[1][::2], winners[0], atol=0.01 * winners[0].max())
    assert winners[0].max() > 1


def test_noise_lets_either_of_two_equals_win():
    model = dd.Model("equals")
    pool = model.add(SoftWinnerTakeAll("pool", [dd.Axis("item", 0, 1, 2)], noise=0.3))
    model.add(Pattern("evidence", [dd.Axis("item", 0, 1, 2)], [1.0, 1.0])) >> pool
    rates = dd.simulate(model, 1500, record=["pool"], every=1500, trials=60)["pool.output"].values[:, -1]
    first = (rates[:, 0] > rates[:, 1]).mean()
    assert 0.25 < first < 0.75
    assert (np.abs(rates.max(1) - 1 / 0.55) < 0.9).all() and (rates.min(1) < 0.4).all()


def test_its_noise_is_that_of_a_field():
    """With noise alone, a linear pool equals a linear field of the same path."""
    x = dd.Axis("x", 0, 4, 9)
    runs = []
    for element in (
        SoftWinnerTakeAll("u", [x], 10.0, self_excitation=0, inhibition=0, noise=0.7, sigmoid=Linear()),
        dd.Field("u", [x], 10.0, 0.0, Linear(), noise=0.7),
    ):
        model = dd.Model("noise")
        model.add(Noise("none", [x], 0.0)) >> model.add(element)
        runs.append(dd.simulate(model, 50, record=["u.output"], precision="float64")["u.output"].values)
    np.testing.assert_allclose(*runs, atol=1e-12)
    assert runs[0].std() > 0.1


def test_with_filtered_input_the_pool_is_a_field_with_inhibition_one_step_late():
    """Inhibition as fast as the step: v(t + dt) is the integral of r(t).

    The pool and a field differ in nothing else.
    """
    x = dd.Axis("x", 0, 100, 51)
    kernel, dt = [dd.Gaussian(12, 5, normalized=True)], 0.5
    model = dd.Model("filter", dt=dt)
    pool = SoftWinnerTakeAll("pool", [x], 20, dt, 0, kernel, 0.0, 0.0, 5.0, sigmoid=dd.Logistic())
    field = dd.Field("u", [x], 20, -5, kernel=kernel)
    slow = model.add(dd.Field("slow", [x], 20, 0, Linear()))
    stimulus = model.add(dd.GaussianStimulus("s", [x], center=40, sigma=5, amplitude=6, windows=[(20, 150)]))
    stimulus >> slow >> model.add(pool)
    stimulus >> model.add(field)
    record = dd.simulate(
        model, 250, record=["u.activation", "pool.interaction", "slow.activation"], precision="float64"
    )
    u = record["pool.interaction"].values + record["slow.activation"].values - 5
    np.testing.assert_allclose(u, record["u.activation"].values, atol=1e-10)
    assert u.max() > 1
