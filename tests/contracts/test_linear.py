"""Couplings that are declared linear superpose: their output for a + b is the sum of their outputs for a
and b.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.model.check import check
from deodar.numerics.axes import Axes
from tests.contracts.build import example, node, record, source

LINEAR = [kind for kind in registry.kinds("couplings") if example(kind).linear]
OTHERS = [kind for kind in registry.kinds("couplings") if not example(kind).linear]


def three(kind: str) -> tuple[dd.Model, Axes]:
    """Return copies of a coupling that read a, b, and both."""
    from tests.contracts.build import around

    axes = node(around(example(kind))).ins["input"]
    model = dd.Model("superposition")
    a, b = (
        model.add(source(name, axes, amplitude, at))
        for name, amplitude, at in (("a", 0.8, 0.3), ("b", -1.7, 0.6))
    )
    for name, sources in {"of a": [a], "of b": [b], "of both": [a, b]}.items():
        copy = model.add(dc.replace(example(kind), name=name))
        for s in sources:
            model.connect(s, copy)
    assert not check(model.document)
    return model, axes


@pytest.mark.parametrize("kind", LINEAR)
def test_linear_couplings_superpose(kind):
    model, _ = three(kind)
    recording = record(model, 3, ["of a", "of b", "of both"], precision="float64", dt=1.0)
    a, b, both = (recording[f"{name}.output"].values for name in ("of a", "of b", "of both"))
    assert abs(a).max() > 0 and abs(b).max() > 0
    np.testing.assert_allclose(both, a + b, rtol=0, atol=1e-12 * max(abs(a).max(), abs(b).max()))


def test_some_couplings_are_linear_and_some_are_not():
    assert {"Gain", "Convolve", "Shift", "Weights", "Weighting", "Project", "Resample", "Sum"} <= set(LINEAR)
    assert {"Sigmoid", "Threshold", "PeakPosition"} <= set(OTHERS)


@pytest.mark.parametrize("how", ["max", "min"])
def test_a_projection_by_maximum_or_minimum_is_not_declared_linear(how):
    assert not dd.Project([], how).linear and dd.Project([], "mean").linear
