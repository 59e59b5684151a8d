"""Functions of each sample, quotients and envelopes."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Envelope, Pointwise, Quotient
from deodar.elements.stimuli import Boost, Pattern

X = dd.Axis("x", 0, 5, 6)
VALUES = np.array([-2.0, -0.5, 0.0, 0.3, 1.0, 3.0])


def out(coupling, port=None, other=None):
    """Return the output for VALUES at the input, and for an array or a number at another port."""
    model = dd.Model("pointwise", dt=1)
    added = model.add(coupling)
    model.add(Pattern("s", [X], VALUES)) >> added
    if port:
        second = Boost("other", (), other) if np.ndim(other) == 0 else Pattern("other", [X], other)
        model.add(second) >> added[port]
    name = f"{coupling.name}.output"
    return dd.simulate(model, 1, record=[name], precision="float64")[name].values[0]


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        ("abs", abs(VALUES)),
        ("square", VALUES**2),
        ("root", np.sqrt(np.maximum(VALUES, 0))),
        ("exp", np.exp(VALUES)),
        ("log", np.log(np.maximum(VALUES, 1e-30))),
        ("sin", np.sin(VALUES)),
        ("cos", np.cos(VALUES)),
    ],
)
def test_each_function(function, expected):
    np.testing.assert_allclose(out(Pointwise(function, name="y")), expected, rtol=1e-14, atol=1e-14)


def test_a_quotient_takes_the_least_divisor_where_the_port_is_smaller():
    divisor = np.array([2.0, -4.0, 0.0, 0.05, -0.05, 1.0])
    expected = VALUES / np.array([2.0, -4.0, 0.1, 0.1, 0.1, 1.0])
    np.testing.assert_allclose(out(Quotient(0.1, name="y"), "divisor", divisor), expected, rtol=1e-14)
    np.testing.assert_allclose(out(Quotient(name="y"), "divisor", 4.0), VALUES / 4, rtol=1e-14)


def test_envelopes_with_a_signal_and_with_a_number():
    other = VALUES[::-1].copy()
    assert np.array_equal(out(Envelope(name="y"), "other", other), np.maximum(VALUES, other))
    assert np.array_equal(out(Envelope("lower", name="y"), "other", 0.25), np.minimum(VALUES, 0.25))
