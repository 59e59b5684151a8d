"""Many steps as one pure function."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError, TimeError
from tests.deodar.gradients.models import X, mixed

RECORD = ["u.activation", "u.output", "node.activation"]


@pytest.mark.parametrize(("n", "every"), [(0, 1), (1, 1), (50, 1), (50, 3), (50, 40), (50, 50)])
def test_it_records_what_simulate_records(n: int, every: int) -> None:
    model = mixed()
    d = dd.dynamics(model)
    record = dd.simulate(model, n, seed=3, trials=[5], record=RECORD, every=every, precision="float64")
    with d.context():
        out = jax.jit(lambda key: dd.rollout(d, n, key=key, record=RECORD, every=every))(d.key(3, 5))
    for path in RECORD:
        assert out.records[path] == pytest.approx(record[path].values[0], abs=1e-12)


def test_it_continues_from_a_state() -> None:
    d = dd.dynamics(mixed())
    with d.context():
        whole = dd.rollout(d, 20, record=RECORD)
        half = dd.rollout(d, 11)
        second = dd.rollout(d, 9, record=RECORD, start=dd.RolloutStart(half.state, 11))
    assert half.records == {}
    for path in RECORD:
        assert second.records[path] == pytest.approx(np.asarray(whole.records[path])[11:], abs=1e-12)


def test_inputs_are_constant_or_have_an_axis_of_steps() -> None:
    d = dd.dynamics(mixed())
    bump = 3 * np.exp(-0.5 * ((X.points - 4) / 2) ** 2)
    moving = np.arange(8) >= 3
    with d.context():
        out = dd.rollout(d, 8, inputs={"u": moving[:, None] * bump, "node": moving * 1.0}, record=["u"])
        prepared, key = d.prepare(), d.key()
        state = d.init(key=key)
        for tick in range(8):
            inputs = {"u": bump, "node": 1.0} if tick >= 3 else {}
            state = d.step(prepared, state, inputs, tick, key)
        with pytest.raises(ParameterError, match="one more with 9 steps"):
            dd.rollout(d, 9, inputs={"u": moving[:, None] * bump})
        with pytest.raises(TimeError):
            dd.rollout(d, -1)
    assert out.records["u"][-1] == pytest.approx(np.asarray(d.named(state)["u.activation"]), abs=1e-12)
