"""The memory trace against its equation."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.memory_trace import MemoryTrace

X = dd.Axis("x", 0, 30, 31)


def test_it_grows_below_peaks_decays_between_them_and_rests_without_any():
    model = dd.Model("trace")
    for name, center, on in (("a", 8, (0, 20)), ("b", 22, (30, 60))):
        model.add(dd.GaussianStimulus(name, [X], center=center, sigma=2, amplitude=2, windows=[on]))
    p = model.add(MemoryTrace("p", [X], tau_build=10, tau_decay=50, threshold=0.5))
    model["a"] >> p
    model["b"] >> p
    data = dd.simulate(model, 80, dt=0.5, record=["p.output", "p.active", "p.input"], precision="float64")
    found, active, s = (data[name].values for name in ("p.output", "p.active", "p.input"))
    wanted = np.zeros(31)
    for k in range(len(found)):
        assert np.allclose(found[k], wanted, rtol=0, atol=1e-13)
        if (s[k] > 0.5).any():
            wanted = wanted + 0.5 * np.where(s[k] > 0.5, (s[k] - wanted) / 10, -wanted / 50)
    assert np.array_equal(active[1:], s[:-1] > 0.5)
    assert np.array_equal(found[40], found[60]) and found[40].max() > 1  # nothing is active from 20 to 30
    assert found[-1, 8] < found[40, 8]
