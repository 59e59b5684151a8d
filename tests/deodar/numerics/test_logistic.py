"""The series of the logistic function's mean."""

from __future__ import annotations

import numpy as np

from deodar.numerics import sigmoids


def test_the_series_has_the_relative_error_that_is_stated() -> None:
    y = np.linspace(1e-6, 1, 10_000)
    exact = np.log1p(y) / y
    assert np.abs(np.polyval(sigmoids._SERIES, y) / exact - 1).max() < 2e-7
