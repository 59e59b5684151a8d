"""Output functions of fields and their means over ranges of activation, against their formulas."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import jax
import numpy as np
import pytest
from scipy.integrate import quad

import deodar as dd
from deodar.numerics.sigmoids import Absolute, Linear, SemiLinear, SigmoidFunction, Step

ALL = [
    dd.Logistic(4.0, 0.3),
    dd.Logistic(1e5),
    Absolute(100.0, 0.3),
    Absolute(3.0),
    Step(0.3),
    Linear(0.7, 0.2),
    SemiLinear(0.7, 0.3),
]
ENDS = [
    (-12.0, 9.0),
    (-2.0, -1.0),
    (0.25, 0.4),
    (0.3, 0.3),
    (0.1, 0.1),
    (5.0, 5.001),
    (-9.0, -8.99),
    (0.29, 0.2901),
    (3.0, -3.0),
    (-40.0, -30.0),
]


def test_the_logistic_is_relatively_exact_far_below_the_threshold():
    u = np.linspace(-20, 20, 4001).astype(np.float32)
    exact = 1 / (1 + np.exp(-4.0 * u.astype(float)))
    output = np.asarray(jax.jit(dd.Logistic(4.0))(u))
    assert output.dtype == np.float32
    np.testing.assert_allclose(output, exact, rtol=1e-5)
    assert np.isclose(float(dd.Logistic(4.0)(np.float32(-4.0))), 1.1253516e-07, rtol=1e-5)
    assert (
        float(dd.Logistic(4.0)(np.float32(-1e6))) == 0.0 and float(dd.Logistic(4.0)(np.float32(1e6))) == 1.0
    )


def exact_mean(g: SigmoidFunction, a: float, b: float) -> float:
    """Return the mean by adaptive integration, in parts that meet at the threshold."""

    def f(u: float) -> float:
        with jax.enable_x64(True):
            return float(g(np.float64(u)))

    if a == b:
        return f(a)
    a, b = min(a, b), max(a, b)
    threshold = getattr(g, "threshold", 0.0)
    around = [threshold + sign * k / getattr(g, "beta", 1.0) for sign in (-1, 1) for k in (0, 3, 30)]
    cuts = sorted({a, b, *(p for p in around if a < p < b)})
    return sum(
        quad(f, p, q, epsabs=1e-13, epsrel=1e-12, limit=200)[0] for p, q in itertools.pairwise(cuts)
    ) / (b - a)


@pytest.mark.parametrize("g", ALL, ids=repr)
def test_the_mean_over_a_range_agrees_with_the_exact_mean(g):
    exact = np.array([exact_mean(g, a, b) for a, b in ENDS])
    ends = np.array(ENDS)
    single = np.asarray(jax.jit(g.mean)(*ends.T.astype(np.float32)))
    assert single.dtype == np.float32
    scale = np.abs(ends).max(1) * getattr(g, "beta", 1.0)
    # activation has 7 digits
    rounded = 1e-5 + 2e-7 * np.minimum(scale, 1 / np.maximum(np.abs(ends[:, 1] - ends[:, 0]), 1e-12) + 30)
    np.testing.assert_array_less(np.abs(single - exact), rounded + 1e-12)
    with jax.enable_x64(True):
        double = np.asarray(jax.jit(g.mean)(*ends.T))
    np.testing.assert_allclose(double, exact, rtol=2e-9, atol=1e-11)


def test_the_mean_of_the_logistic_is_relatively_exact_far_below_the_threshold():
    g, low = dd.Logistic(4.0), np.linspace(-15, -1, 400)
    for width in (0.0, 1e-3, 0.011, 0.1, 1.0):
        a, b = low.astype(np.float32), (low + width).astype(np.float32)
        softplus = np.log1p(np.exp(4.0 * np.stack([a, b]).astype(float)))
        d = 4.0 * (b.astype(float) - a)
        exact = np.where(
            d > 0,
            (softplus[1] - softplus[0]) / np.where(d > 0, d, 1),
            1 / (1 + np.exp(-4.0 * a.astype(float))),
        )
        np.testing.assert_allclose(np.asarray(g.mean(a, b)), exact, rtol=3e-5)


def test_a_sigmoid_without_an_antiderivative_is_averaged_by_points():
    @dataclass(frozen=True)
    class Cubic(SigmoidFunction):
        def __call__(self, u):
            return u**3 - u

    assert np.isclose(Cubic().mean(-1.0, 3.0), 4.0, rtol=1e-12)
    assert Cubic().ends(1.0) is None
