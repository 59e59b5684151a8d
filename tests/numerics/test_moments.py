"""Moments are made whole numbers of steps where only rounding keeps them from it."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.numerics.moments import on_grid


@pytest.mark.parametrize("dt", [0.1, 1.0, 64.0])
def test_rounding_goes_and_what_lies_between_steps_stays(dt):
    step, steps = np.float32(dt), np.arange(5000, dtype=np.float32)
    exact = np.asarray(on_grid(steps * step, step))
    for wrong in (-1e-7, 2e-7):
        np.testing.assert_array_equal(np.asarray(on_grid(np.float32(steps * step * (1 + wrong)), step)), exact)
    between = np.float32((steps[:1000] + 0.37) * step)
    np.testing.assert_array_equal(np.asarray(on_grid(between, step)), between)
