"""Shifts: linear interpolation between samples, at the ends of lines and on rings, by any amount."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import deodar as dd
from deodar.couplings.convolutions import Shift
from deodar.elements.stimuli import Pattern
from deodar.numerics import resampling


@given(samples=st.sampled_from((2, 3, 8, 11)), amount=st.floats(-40, 40), periodic=st.booleans())
def test_a_shift_is_the_matrix_that_interpolates(samples, amount, periodic):
    axis = dd.Axis("x", -2.0, 7.0, samples, periodic=periodic)
    y = np.random.default_rng(samples).normal(size=samples)
    with jax.enable_x64(True):
        whole, part = resampling.steps(axis, amount, np.dtype("float64"))
        moved = np.asarray(resampling.shifted(jax.numpy.asarray(y), 0, periodic, whole, part))
        matrix = np.asarray(resampling.weights(axis, axis.points - amount, "linear", np.dtype("float64")))
    np.testing.assert_allclose(moved, matrix @ y, atol=1e-9)


def shifted(amount, axes, pattern):
    model = dd.Model("shift")
    source = model.add(Pattern("source", axes, pattern))
    model.connect(source, model.add(Shift(amount, name="shift")))
    return dd.simulate(model, 1, dt=1.0, record="shift.output")["shift.output"].values[-1]


@pytest.mark.parametrize("amount", [(3.0, -2.0), (0.0, 0.0), (20.0, 0.0)])
def test_a_shift_by_whole_samples_keeps_the_bits(amount):
    axes = [dd.Axis("x", 0, 9, 10), dd.Axis("y", 0, 7, 8)]
    pattern = np.random.default_rng(0).normal(size=(10, 8)).astype(np.float32)
    expected = np.zeros_like(pattern)
    dx, dy = (int(a) for a in amount)
    for i in range(10):
        for j in range(8):
            if 0 <= i - dx < 10 and 0 <= j - dy < 8:
                expected[i, j] = pattern[i - dx, j - dy]
    np.testing.assert_array_equal(shifted(amount, axes, pattern), expected)


def test_a_shift_by_whole_samples_of_an_inexact_step_counts_as_whole():
    axis = dd.Axis("x", 0, 0.9, 10)
    whole, part = resampling.steps(axis, 0.3, np.dtype("float32"))
    assert int(whole) == 3 and float(part) < 1e-6
