"""The logarithm against its formula."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.couplings.arithmetic import Logarithm
from deodar.elements.stimuli import Pattern


def test_the_logarithm_compresses_and_is_zero_for_negative_input() -> None:
    values = np.array([-20.0, 0.0, 50.0, 676.0, 4095.0])
    model = dd.Model("log")
    source = model.add(Pattern("read", [dd.Axis("sensor", 0, 4, 5)], values))  # type: ignore[arg-type]
    source >> model.add(Logarithm(5.0, 50.0, name="loudness"))
    y = dd.simulate(model, 1, record="loudness.output")["loudness.output"].values[-1]
    np.testing.assert_allclose(y, 5 * np.log(1 + np.maximum(values, 0) / 50), rtol=1e-6)
    assert y[0] == y[1] == 0
