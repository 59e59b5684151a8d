"""Expansion along diagonals."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.couplings.projections import DiagonalExpansion
from deodar.elements.stimuli import Pattern

X, Y, Z = dd.Axis("x", 0, 6, 4), dd.Axis("y", 10, 14, 3), dd.Axis("z", 10, 20, 6)


def test_each_position_is_expanded_along_its_diagonal():
    model = dd.Model("diagonals")
    model.add(Pattern("in", [Z], np.arange(6.0) ** 2)) >> DiagonalExpansion([X, Y], name="out")
    output = dd.simulate(model, 1, every=1, record=["out.output"], precision="float64")["out.output"].values[
        0
    ]
    assert output.tolist() == [[float((i + j) ** 2) for j in range(3)] for i in range(4)]


def test_axes_that_do_not_fit_are_reported():
    for axes, says in (
        ([X], "between two"),
        ([X, X], "two of its axes"),
        ([X, dd.Axis("y", 0, 1, 9)], "are 12"),
    ):
        model = dd.Model("misfit")
        model.add(dd.GaussianStimulus("in", [Z])) >> DiagonalExpansion(axes, name="out")
        assert any(says in p.what for p in model.check())
