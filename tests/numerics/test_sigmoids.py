"""Output functions of fields, against their formulas."""

from __future__ import annotations

import jax
import numpy as np

import deodar as dd


def test_the_logistic_is_relatively_exact_far_below_the_threshold():
    u = np.linspace(-20, 20, 4001).astype(np.float32)
    exact = 1 / (1 + np.exp(-4.0 * u.astype(float)))
    found = np.asarray(jax.jit(dd.Logistic(4.0))(u))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, exact, rtol=1e-5)
    assert np.isclose(float(dd.Logistic(4.0)(np.float32(-4.0))), 1.1253516e-07, rtol=1e-5)
    assert float(dd.Logistic(4.0)(np.float32(-1e6))) == 0.0 and float(dd.Logistic(4.0)(np.float32(1e6))) == 1.0
