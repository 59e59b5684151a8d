"""A world inside the step: trials by vmap are single runs, and gradients are finite differences."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError

HALL = {"unit": "cm", "arena": {"x": [0, 100], "y": [0, 40]}}
STEPS = 12


def driving() -> tuple[dd.Model, dd.Arena]:
    """Return a vehicle whose pose drives a noisy node, and an arena with a start for each trial."""
    model = dd.Model("driving", time_unit="1 = 64 ms")
    for wheel in ("left", "right"):
        model.add(dd.Boost(f"go {wheel}", amplitude=300.0)) >> model.add(dd.Motor(wheel, motor=wheel))
    pose = model.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    node = model.add(dd.Field("u", [], tau=5, resting_level=-1, noise=0.3))
    pose >> model.add(dd.Weights(np.full(3, 0.01), [], name="sum")) >> node
    return model, dd.Arena(HALL, start=[(10, 20, 0.1), (12, 20, 0.0), (10, 22, -0.1)], unit="cm")


def test_trials_and_seeds_by_vmap_are_single_runs_and_those_of_simulate() -> None:
    model, world = driving()
    d = dd.dynamics(model, world=world)
    with d.context():

        def course(key: Any) -> Any:
            return dd.rollout(d, STEPS, key=key, record=["u"]).records["u"]

        keys = [d.key(3, 0), d.key(3, 1), d.key(3, 2), d.key(4, 0)]
        together = jax.jit(jax.vmap(course))(jax.tree.map(lambda *leaves: jnp.stack(leaves), *keys))
        alone = jax.jit(course)
        single = [alone(key) for key in keys]
        with pytest.raises(WorldError, match="Make the keys outside"):
            jax.vmap(lambda seed: course(d.key(seed)))(jnp.arange(2))
    np.testing.assert_allclose(together, single, rtol=0, atol=1e-12)
    assert len({float(run[-1]) for run in single}) == 4
    record = dd.simulate(model, STEPS, record="u", world=world, seed=3, trials=3, precision="float64")
    np.testing.assert_allclose(record["u.activation"], together[:3], rtol=0, atol=1e-12)


def test_a_gradient_through_a_world_is_that_of_finite_differences() -> None:
    model, world = driving()
    d = dd.dynamics(model, ["go left.amplitude"], world=world)
    with d.context():
        key = d.key(0, 0)

        def ends(amplitude: Any) -> Any:
            run = dd.rollout(d, STEPS, {"go left.amplitude": amplitude}, key=key, record=["pose", "u"])
            return jnp.append(run.records["pose"][-1], run.records["u"][-1])

        by = jax.jit(jax.jacrev(ends))(300.0)
        final = jax.jit(ends)
        slopes = (final(300.001) - final(299.999)) / 0.002
    assert np.abs(by).min() > 0
    np.testing.assert_allclose(by, slopes, rtol=1e-5)
