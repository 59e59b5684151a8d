"""Noise of running models: moments, correlations, independence, and its scaling with steps and grids."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import deodar as dd
from deodar.elements.changing_stimuli import Noise

N = 400
LINE = dd.Axis("x", 0, 199.5, N)
STEPS = 2000


@pytest.fixture(scope="module")
def drawn():
    """Return deviates of two sources over time, two trials, at unit amplitude: (source, trial, time,
    cell).
    """
    model = dd.Model("noise")
    for name in "ab":
        model.add(Noise(name, [LINE]))
    seen = []
    for seed in (0, 1):
        record = dd.simulate(model, STEPS, seed=seed, trials=2, record=["a", "b"])
        seen.append([record[f"{name}.output"].values[:, :-1] * np.sqrt(LINE.step) for name in "ab"])
    return np.array(seen, dtype=np.float64)


def within(number, expected, deviation):
    """Five standard errors: a sound generator fails one time in two million."""
    assert abs(number - expected) < 5 * deviation, (
        f"{number} is {abs(number - expected) / deviation:.1f} standard errors from {expected}"
    )


def test_moments_of_the_deviates_are_those_of_a_normal_distribution(drawn):
    for z in drawn.reshape(8, -1):
        n = z.size
        within(z.mean(), 0, 1 / np.sqrt(n))
        within(z.var(), 1, np.sqrt(2 / n))
        within(stats.skew(z), 0, np.sqrt(6 / n))
        within(stats.kurtosis(z), 0, np.sqrt(24 / n))


def test_tails_and_distribution_of_the_deviates_are_normal(drawn):
    z = drawn.ravel()
    for level in (0.5, 1, 2, 3, 4, 4.5):
        p = 2 * stats.norm.sf(level)
        within(np.mean(abs(z) > level), p, np.sqrt(p * (1 - p) / z.size))
    assert stats.kstest(z[:200_000], "norm").pvalue > 1e-4


def test_every_cell_and_every_step_is_normal(drawn):
    z = drawn[0, 0, 0]
    for axis, n in ((0, STEPS), (1, N)):
        spread = z.var(axis=axis)
        assert abs(z.mean(axis=axis)).max() < 5.5 / np.sqrt(n)
        assert abs(spread - 1).max() < 5.5 * np.sqrt(2 / n) + 12 / n


@pytest.mark.parametrize("lag", [1, 2, 3, 4])
def test_steps_and_neighbours_are_uncorrelated(drawn, lag):
    z = drawn[0, 0, 0]
    within((z[lag:] * z[:-lag]).mean(), 0, 1 / np.sqrt(z[lag:].size))
    within((z[:, lag:] * z[:, :-lag]).mean(), 0, 1 / np.sqrt(z[:, lag:].size))
    # the two deviates of a pair share their radius unless they are independent
    within((z[lag:] ** 2 * z[:-lag] ** 2).mean(), 1, np.sqrt(8 / z[lag:].size))


def test_elements_trials_and_seeds_are_independent(drawn):
    flat = drawn.reshape(8, -1)
    for i in range(8):
        for j in range(i):
            within((flat[i] * flat[j]).mean(), 0, 1 / np.sqrt(flat.shape[1]))
            within((flat[i] ** 2 * flat[j] ** 2).mean(), 1, np.sqrt(8 / flat.shape[1]))


@pytest.mark.parametrize("every", [1, 2, 5])
def test_euler_increments_have_the_variance_of_their_step(every):
    """Per step of a part: q^2 k dt / (tau^2 cell), for a field's own noise and for a source in its input."""
    dt, tau, q, steps = 0.5, 12.0, 0.7, 3000
    model = dd.Model("increments")
    field = dd.Field("own", [LINE], tau=tau, resting_level=0, noise=q)
    fed = dd.Field("fed", [LINE], tau=tau, resting_level=0)
    model.add(field, ticks=every)
    model.connect(model.add(Noise("n", [LINE], q), ticks=every), model.add(fed, ticks=every))
    record = dd.simulate(
        model, steps * dt, dt=dt, every=every * dt, record=["own.activation", "fed.activation"]
    )
    expected = q**2 * every * dt / tau**2 / LINE.step
    for name in ("own", "fed"):
        u = record[f"{name}.activation"].values.astype(float)
        increments = u[1:] - u[:-1] * (1 - every * dt / tau)
        within(increments.var() / expected, 1, np.sqrt(2 / increments.size))
        within(increments.mean() / np.sqrt(expected), 0, 1 / np.sqrt(increments.size))
        within((increments[1:] * increments[:-1]).mean() / expected, 0, 1 / np.sqrt(increments[1:].size))


def test_the_variance_of_a_field_at_rest_is_that_of_theory():
    """Without interaction the activation is an Ornstein-Uhlenbeck process: variance q^2 / (2 tau) a cell, for
    small steps.
    """
    tau, q, dt = 10.0, 0.5, 0.5
    model = dd.Model("wander")
    model.add(dd.Field("u", [LINE], tau=tau, resting_level=-1, noise=q, sigmoid=dd.Logistic()))
    u = dd.simulate(model, 4000, dt=dt, every=50, record="u.activation")["u.activation"].values[2:]
    expected = q**2 / (tau * (2 - dt / tau)) / LINE.step
    within(u.var() / expected, 1, 1.5 * np.sqrt(2 / u.size))
    within(u.mean(), -1, 1.5 * np.sqrt(expected / u.size))


def test_white_noise_scales_with_the_root_of_the_cell():
    """A finer grid does not change the variance of the noise integrated over an interval."""
    model = dd.Model("grids")
    for n in (51, 101, 201):
        model.add(Noise(f"n{n}", [dd.Axis("x", 0, 100, n)]))
    plane = [dd.Axis("x", 0, 10, 11), dd.Axis("y", 0, 4, 8, periodic=True)]
    model.add(Noise("plane", plane))
    model.add(Noise("number", []))
    steps = 1000
    record = dd.simulate(model, steps, record=["n51", "n101", "n201", "plane", "number"])
    for name, volume in (("n51", 2.0), ("n101", 1.0), ("n201", 0.5), ("plane", 0.5), ("number", 1.0)):
        z = record[f"{name}.output"].values
        within(z.var() * volume, 1, np.sqrt(2 / z.size))


SHORT = dd.Axis("x", 0, 39, 40)
ROUND = dd.Axis("x", 0, 40, 40, periodic=True)


@pytest.mark.parametrize("axis", [SHORT, ROUND], ids=["line", "ring"])
def test_correlated_noise_has_the_stated_variance_and_correlation(axis):
    """The amplitude is the standard deviation at every point, borders included; the correlation is a
    Gaussian.
    """
    length, q, steps = 3.0, 0.8, 20_000
    model = dd.Model("correlated")
    model.add(Noise("n", [axis], q, length=length))
    z = dd.simulate(model, steps, record="n", every=1)["n.output"].values.astype(float) / q
    n = len(z)
    assert abs(z.var(axis=0) - 1).max() < 5 * np.sqrt(2 / n)
    for d in range(1, 9):
        pairs = [(i, i + d) for i in range(10, 22)]  # away from the borders
        correlation = np.mean([(z[:, i] * z[:, j]).mean() for i, j in pairs])
        assert abs(correlation - np.exp(-(d**2) / (2 * length**2))) < 5 / np.sqrt(n)
    across = (z[:, 0] * z[:, -1]).mean()
    assert abs(across - (np.exp(-1 / (2 * length**2)) if axis.periodic else 0)) < 5 / np.sqrt(n)
    assert abs((z[1:] * z[:-1]).mean()) < 5 / np.sqrt(n)


def test_correlated_noise_of_a_field_is_that_of_the_source():
    axes = [dd.Axis("x", 0, 19, 20), dd.Axis("y", 0, 10, 10, periodic=True)]
    model = dd.Model("same")
    model.add(dd.Field("own", axes, tau=5, noise=0.6, noise_length=[2.5, 1.5], resting_level=0))
    model.connect(
        model.add(Noise("n", axes, 0.6, length=[2.5, 1.5])),
        model.add(dd.Field("fed", axes, tau=5, resting_level=0)),
    )
    record = dd.simulate(model, 8000, dt=0.5, every=0.5, record=["own.activation", "fed.activation"])
    for name in ("own", "fed"):
        u = record[f"{name}.activation"].values.astype(float)
        increments = (u[1:] - u[:-1] * (1 - 0.1)) / (0.6 * np.sqrt(0.5) / 5)
        n = len(increments)
        assert abs(increments.var(axis=0) - 1).max() < 5.5 * np.sqrt(2 / n)
        for d in (1, 2, 3):
            assert abs(
                (increments[:, 6, :] * increments[:, 6 + d, :]).mean() - np.exp(-(d**2) / (2 * 2.5**2))
            ) < 5 / np.sqrt(n)
            assert abs(
                (increments[:, 6:14, 2] * increments[:, 6:14, 2 + d]).mean() - np.exp(-(d**2) / (2 * 1.5**2))
            ) < 5 / np.sqrt(n)
