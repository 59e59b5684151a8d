"""Sums along diagonals."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.couplings.projections import DiagonalSum
from deodar.elements.stimuli import Pattern

X, Y = dd.Axis("x", 0, 6, 4), dd.Axis("y", 10, 14, 3)
VALUES = np.arange(12.0).reshape(4, 3) ** 2


def test_each_diagonal_is_summed():
    model = dd.Model("diagonals")
    model.add(Pattern("in", [X, Y], VALUES)) >> DiagonalSum([dd.Axis("z", 10, 20, 6)], name="out")
    output = dd.simulate(model, 1, every=1, record=["out.output"], precision="float64")["out.output"].values[
        0
    ]
    # 2: the step of y
    expected = [2.0 * sum(VALUES[i, k - i] for i in range(4) if 0 <= k - i < 3) for k in range(6)]
    assert np.allclose(output, expected)


def test_axes_that_do_not_fit_are_reported():
    for source, samples, says in (([X], 6, "two axes"), ([X, Y], 5, "are 6")):
        model = dd.Model("misfit")
        model.add(dd.GaussianStimulus("in", source)) >> DiagonalSum([dd.Axis("z", 0, 1, samples)], name="out")
        assert any(says in p.what for p in model.check())
