"""Truncated kernels: their reach, their sums, and their effect in a field."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.convolutions import Convolve
from deodar.elements.stimuli import Pattern
from deodar.numerics.kernels.separable import TruncatedGaussian

LINE, RING, EVEN = (
    dd.Axis("x", 0, 30, 11),
    dd.Axis("phi", 0, 360, 11, periodic=True),
    dd.Axis("phi", 0, 360, 12, periodic=True),
)


def response(kernel, axis, at=5, precision="float64"):
    """Return the response to a single sample."""
    model = dd.Model("response")
    values = np.zeros(axis.samples)
    values[at] = 1.0
    model.add(Pattern("in", [axis], values)) >> Convolve([kernel], name="out")
    return dd.simulate(model, 1, record=["out.output"], every=1, precision=precision)["out.output"].values[0]


@pytest.mark.parametrize("precision", ["float64", "float32"])
@pytest.mark.parametrize(("cutoff", "reach"), [(0.0, 0), (0.9, 1), (1.0, 1), (1.01, 2), (2.5, 3), (100.0, 5)])
def test_a_truncated_gaussian_ends_at_the_cutoff(cutoff, reach, precision):
    seen = response(TruncatedGaussian(2.0, 3.0, cutoff), LINE, precision=precision)
    assert np.flatnonzero(seen > 1e-30).tolist() == list(range(5 - reach, 5 + reach + 1))
    assert seen[5] == pytest.approx(2.0 * LINE.step)
    if reach:
        assert seen[6] == pytest.approx(2.0 * LINE.step * np.exp(-0.5), rel=1e-6)


@pytest.mark.parametrize("axis", [RING, EVEN], ids=["odd", "even"])
@pytest.mark.parametrize(("sigma", "cutoff"), [(20.0, 1.0), (60.0, 2.0), (200.0, 5.0)])
def test_on_a_ring_every_sample_counts_once(axis, sigma, cutoff):
    seen = response(TruncatedGaussian(1.5, sigma, cutoff, normalized=True), axis)
    assert seen.sum() == pytest.approx(1.5, rel=1e-12)
    turned = np.roll(seen, -5)
    assert np.allclose(turned[1:], turned[1:][::-1], rtol=0, atol=1e-15)


def test_normalization_on_a_line_is_over_the_whole_support():
    kernel = TruncatedGaussian(1.0, 6.0, 1.5, normalized=True)
    lags = np.arange(-3, 4)
    weights = np.exp(-0.5 * (lags * 3 / 6) ** 2)
    assert response(kernel, LINE)[2:9] == pytest.approx(weights / weights.sum(), rel=1e-12)
    assert response(kernel, LINE, at=0).sum() == pytest.approx(weights[3:].sum() / weights.sum(), rel=1e-12)


def test_the_least_reach_extends_a_narrow_kernel():
    assert (response(TruncatedGaussian(1.0, 3.0, 1.0, least=9.0), LINE) > 0).sum() == 7


def test_a_kernel_much_narrower_than_a_step_is_one_sample():
    assert (
        response(TruncatedGaussian(1.5, 1e-6, 5.0, normalized=True), RING).tolist()
        == [0] * 5 + [1.5] + [0] * 5
    )


def test_a_kernel_of_amplitude_zero_has_no_terms_until_it_is_set():
    model = dd.Model("back")
    u = model.add(dd.Field("u", [LINE], kernel=[TruncatedGaussian(0.0, 3.0)], resting_level=1.0))
    assert u.element.kernel[0].terms() == ()
    s = dd.Session(model, precision="float64")
    assert s.set("u.kernel.0.amplitude", 1.0) == "recompile" and s.set("u.kernel.0.amplitude", 2.0) == "live"
    assert s.set("u.kernel.0.sigma", 4.0) == "rebuild"
    assert np.ptp(s.read("u.interaction")) > 0.1
