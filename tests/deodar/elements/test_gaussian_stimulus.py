"""Options of a Gaussian stimulus: normalisation, and boundaries that differ from those of its axes."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd

LINE, RING = dd.Axis("x", 0, 30, 11), dd.Axis("phi", 0, 360, 12, periodic=True)


def seen(**values):
    model = dd.Model("stimulus")
    model.add(dd.GaussianStimulus("s", values.pop("axes"), **values))
    return dd.simulate(model, 1, every=1, record=["s.output"], precision="float64")["s.output"].values[0]


def test_the_amplitude_of_a_normalized_stimulus_is_its_integral():
    y = seen(axes=[LINE, RING], center=[1, 350], sigma=[6, 50], amplitude=2.5, normalized=True)
    assert y.sum() * LINE.step * RING.step == pytest.approx(2.5, rel=1e-12)
    assert np.allclose(
        y / y.max(),
        seen(axes=[LINE, RING], center=[1, 350], sigma=[6, 50])
        / seen(axes=[LINE, RING], center=[1, 350], sigma=[6, 50]).max(),
    )
    assert not seen(axes=[LINE], center=1.5, sigma=1e-6, normalized=True).any()


def test_the_boundary_of_a_stimulus_may_differ_from_that_of_its_axis():
    wrapped, cut = (
        seen(axes=[LINE], center=0, sigma=6, boundary="periodic"),
        seen(axes=[RING], center=0, sigma=60, boundary="zero"),
    )
    d = np.minimum(np.arange(11), 11 - np.arange(11)) * 3
    assert np.allclose(wrapped, np.exp(-0.5 * (d / 6) ** 2))
    assert np.allclose(cut, np.exp(-0.5 * (np.arange(12) * 30 / 60) ** 2))


def test_a_wrong_number_of_boundaries_is_a_problem():
    model = dd.Model("misfit")
    model.add(dd.GaussianStimulus("s", [LINE], boundary=["zero", "zero"]))
    assert any("2 entries" in p.what for p in model.check())
