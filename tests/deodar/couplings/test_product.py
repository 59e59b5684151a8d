"""The product: the axes of its factor."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.model.check import problems

X, Y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 4, samples=5)


def product(axes: list[dd.Axis], factor: list[dd.Axis]) -> dd.Model:
    model = dd.Model("m")
    target = model.add(Product(name="p"))
    model.connect(model.add(dd.Boost("u", axes, 2.0)), target)
    model.connect(model.add(dd.Boost("f", factor, 3.0)), target["factor"])
    return model


def test_a_factor_with_more_axes_is_refused_with_advice_to_exchange_the_inputs() -> None:
    (problem,) = problems(product([X], [X, Y]).document)
    assert (
        "f.output" in str(problem) and "it has more axes" in str(problem) and "change places" in str(problem)
    )


@pytest.mark.parametrize(
    "factor", [[X], [], [dd.Axis("x", 0, 10, samples=6)]], ids=["same", "none", "other samples"]
)
def test_a_factor_with_the_same_axes_or_fewer_fits(factor: list[dd.Axis]) -> None:
    model = product([X], factor)
    assert not problems(model.document)
    record = dd.simulate(model, 1, dt=1, record=["p.output"])
    np.testing.assert_allclose(record["p.output"].values, 6.0, rtol=1e-6)
