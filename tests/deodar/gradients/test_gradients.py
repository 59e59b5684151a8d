"""Gradients of many steps: their values, what refuses them, and their memory."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.compiler.dynamics import Dynamics
from deodar.errors import DerivativeError, ParameterError
from tests.deodar.gradients.models import X, field, mixed

GIGABYTE = 1e9


def total(d: Dynamics, n: int, record: str = "u") -> Any:
    """Return a function of parameters: the sum of squares of what is recorded."""
    return lambda p: (dd.rollout(d, n, p, record=[record]).records[record] ** 2).sum()


def test_a_gradient_with_noise_delays_and_slow_parts_is_that_of_finite_differences() -> None:
    paths = ["u.tau", "u.noise", "u.kernel.0.sigma", "trace.tau_build", "sum.weights", "gain.factor"]
    d = dd.dynamics(mixed(), paths)
    with d.context():
        for port in ("u", "node"):
            function = jax.jit(total(d, 60, port))
            slopes = jax.jit(jax.grad(total(d, 60, port)))(d.parameters)
            for path, slope in slopes.items():
                direction = np.cos(np.arange(slope.size)).reshape(slope.shape)
                moved = ({**d.parameters, path: d.parameters[path] + e * direction} for e in (1e-5, -1e-5))
                ends = [float(function(parameters)) for parameters in moved]
                by = float(np.sum(np.asarray(slope) * direction))
                assert by == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-6, abs=1e-6), path


TEN_THOUSAND_STEPS = """
import pathlib
import jax, numpy as np
import deodar as dd
from tests.deodar.gradients.models import field
from tests.deodar.gradients.test_gradients import total

d = dd.dynamics(field(0.5, samples=100), ["u.tau", "u.kernel.0.sigma"])
with d.context():
    compiled = jax.jit(jax.grad(total(d, 10_000))).lower(d.parameters).compile()
    assert all(np.isfinite(slope) and slope for slope in compiled(d.parameters).values())
# the ru_maxrss of a process begins with that of the one that started it
status = dict(line.split(":", 1) for line in pathlib.Path("/proc/self/status").read_text().splitlines())
peak = int(status["VmHWM"].split()[0]) * 1024
print(compiled.memory_analysis().temp_size_in_bytes, peak)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads the peak from /proc")
def test_ten_thousand_steps_of_a_hundred_samples_need_less_than_a_gigabyte() -> None:
    """The peak of a fresh process, with Python and JAX, which is about 0.4 GB."""
    process = subprocess.run([sys.executable, "-c", TEN_THOUSAND_STEPS], capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    temporary, peak = map(int, process.stdout.split())
    assert temporary < 0.1 * GIGABYTE and peak < GIGABYTE


def test_a_gradient_through_a_jump_is_refused_by_name() -> None:
    model = field()
    model.set("u.sigmoid", dd.Step())
    d = dd.dynamics(model, ["s.amplitude"])
    with d.context():
        assert np.isfinite(total(d, 5)(d.parameters))
        with pytest.raises(DerivativeError, match=r"u \(Field\)"):
            jax.grad(total(d, 5))(d.parameters)
        with pytest.raises(DerivativeError, match=r"u \(Field\)"):
            jax.jit(jax.grad(total(d, 5)))(d.parameters)


def test_a_winner_position_is_refused_where_a_gradient_reaches_it() -> None:
    model = field()
    model.connect("u", model.add(dd.MaximumPosition(name="winner")))
    d = dd.dynamics(model, ["s.amplitude", "winner.absent"])
    with d.context():
        with pytest.raises(DerivativeError, match=r"winner \(MaximumPosition\).*input"):
            jax.grad(total(d, 3, "winner"))(d.parameters)
        assert jax.jit(jax.grad(total(d, 1, "winner")))({"winner.absent": 2.0})["winner.absent"] == 8.0


def test_moments_of_windows_have_no_derivative() -> None:
    d = dd.dynamics(field(), ["s.windows.0.start", "s.amplitude"])
    with d.context():
        late = dd.rollout(d, 5, {"s.windows.0.start": 4.0}, record=["s.output"]).records["s.output"]
        assert (np.asarray(late).max(axis=1) > 0).tolist() == [False] * 4 + [True] * 2
        with pytest.raises(DerivativeError, match=r"windows\.0\.start"):
            jax.grad(total(d, 5))(d.parameters)
        assert np.isfinite(jax.jit(jax.grad(total(d, 5)))({"s.amplitude": 4.0})["s.amplitude"])


def test_what_is_off_is_no_parameter() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X], noise=1.0))
    with pytest.raises(ParameterError, match="is off at 0"):
        dd.dynamics(model, ["u.noise_length"])


def test_compiled_kernels_are_not_used_in_single_precision() -> None:
    d = dd.dynamics(mixed(), ["u.tau"], precision="float32")
    assert d.executable.kernels is None
    assert np.isfinite(jax.jit(jax.grad(total(d, 5)))(d.parameters)["u.tau"])


def test_a_traced_value_in_a_model_or_in_simulate_names_rollout() -> None:
    def fixed(tau: Any) -> Any:
        model = field()
        model.set("u.tau", tau)
        return dd.simulate(model, 3)

    def swept(tau: Any) -> Any:
        return dd.simulate(field(), 3, sweep={"u.tau": [tau, 2 * tau]})

    def weights(scale: Any) -> Any:
        return dd.Weights(scale * np.eye(21), [X])

    for function in (fixed, swept, weights):
        with pytest.raises(ParameterError, match=r"dd\.rollout"):
            jax.jit(function)(1.0)
