"""Peaks inside a compiled function against those of `dd.peaks`."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.analysis.maps.patterns import count, widest


@pytest.mark.parametrize("periodic", [False, True])
def test_peaks_are_those_of_dd_peaks(periodic):
    axis = dd.Axis("x", -3, 7, 24, periodic)
    rng = np.random.default_rng(1)
    rough = rng.normal(size=(200, 24)) + rng.normal(size=(200, 1))
    patterns = np.concatenate(
        [rough, np.cumsum(rough, axis=1), np.full((1, 24), 1.0), np.full((1, 24), -1.0)]
    )
    patterns = patterns.astype(np.float32)
    expected_peaks = [dd.peaks(pattern, [axis]) for pattern in patterns]
    assert count(jnp.asarray(patterns), (axis,)).tolist() == [len(peaks) for peaks in expected_peaks]
    assert {len(peaks) for peaks in expected_peaks} >= {0, 1, 2, 5}
    sizes = [max((peak.size for peak in peaks), default=0.0) for peaks in expected_peaks]
    assert np.asarray(widest(jnp.asarray(patterns), axis)) == pytest.approx(sizes, abs=1e-4)


def test_an_active_node_has_one_peak():
    assert count(jnp.asarray([-1.0, 0.0, 2.0]), ()).tolist() == [0, 0, 1]
