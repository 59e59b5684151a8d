"""Parameters as numbers without bounds."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError
from deodar.gradients.bounded import bounds
from tests.deodar.gradients.models import field, mixed


def test_the_bounds_are_declared_or_those_of_the_step() -> None:
    d = dd.dynamics(mixed(), ["u.tau", "trace.tau_build", "u.kernel.0.amplitude", "u.noise", "sum.weights"])
    limits = bounds(d)
    assert limits["u.tau"].lower == 1.0 and limits["trace.tau_build"].lower == 3.0
    assert limits["u.kernel.0.amplitude"] == limits["sum.weights"] == (None, None)
    assert limits["u.noise"] == (0.0, None)


def test_both_ways_are_inverse_and_any_number_is_inside() -> None:
    d = dd.dynamics(mixed(), ["u.tau", "u.noise", "u.kernel.0.sigma", "u.resting_level", "sum.weights"])
    with d.context():
        z = dd.unbounded(d, d.parameters)
        back = dd.bounded(d, z)
        far = dd.bounded(d, jax.tree.map(lambda a: a - 30.0, z))
    for path, parameter in d.parameters.items():
        assert back[path] == pytest.approx(parameter, rel=1e-12)
        lower = bounds(d)[path].lower
        assert lower is None or float(far[path]) >= lower
    assert far["u.resting_level"] == pytest.approx(-32.0)


def test_a_value_on_its_bound_is_refused() -> None:
    d = dd.dynamics(field(0.0), ["u.noise"])
    with d.context(), pytest.raises(ParameterError, match="above 0"):
        dd.unbounded(d, d.parameters)


def test_a_fit_does_not_leave_the_bounds() -> None:
    d = dd.dynamics(field(0.0), ["u.tau"])

    def error(z):
        return (dd.rollout(d, 10, dd.bounded(d, z), record=["u"]).records["u"][-1] ** 2).sum()

    with d.context():
        z = dd.unbounded(d, {"u.tau": np.float64(1.5)})
        slope = jax.jit(jax.grad(error))(z)["u.tau"]
    assert np.isfinite(slope)
