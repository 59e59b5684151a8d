"""What follows from readings of a world alone is computed when the world is read, not at every step."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.compiler.executable import executable
from deodar.experiments.batch import run_batch
from deodar.session.exchange import embodied

X, Y = dd.Axis("x", 0, 1.2, 25), dd.Axis("y", 0, 0.8, 17)


def _model(dt: float = 4.0) -> dd.Model:
    """A map of the arena through a kernel, into a field; the wheels turn all the time."""
    m = dd.Model("map", dt=dt)
    m.add(dd.Sensor("map", [X, Y], sensor="obstacles")) >> m.add(
        dd.Convolve([dd.Gaussian(2.0, 0.1)], name="smooth")
    )
    m.add(dd.Sensor("distance", [dd.Axis("of", 0, 7, 8)], sensor="infrared")) >> m.add(
        dd.Gain(0.01, name="scaled")
    )
    m["smooth"] >> m.add(dd.Field("u", [X, Y], resting_level=-1.0))
    m["scaled"] >> m.add(dd.Field("near", [dd.Axis("of", 0, 7, 8)]))
    for side, speed in (("left", 300.0), ("right", 500.0)):
        m.add(dd.Boost(f"speed {side}", [], speed)) >> m.add(dd.Motor(side, motor=side))
    return m


def _sensory(dt: float) -> set[str]:
    m = _model(dt)
    body = embodied(m.document, dd.Arena("blocks"))
    plan = executable(m, body=body).plan
    return {n.path for group in plan.groups if group.sensory for n in group.nodes}


def test_couplings_of_readings_are_sensory_where_readings_last_several_steps() -> None:
    assert _sensory(4.0) == {"smooth", "scaled"}
    assert _sensory(64.0) == set()


@pytest.mark.parametrize("watch", ["u.activation", "near.activation", "scaled.output"])
def test_they_have_the_values_that_a_session_computes_outside_the_step(watch: str) -> None:
    m, arena = _model(), dd.Arena("blocks", infrared_noise=1.0, slip=0.1)
    arena.place("visitor", (0.9, 0.6), (0.1, 0.1), windows=(200.0, 400.0))
    [inside] = run_batch(m, 640.0, [3], [watch], world=arena, seed=1, every=4.0)
    outside = dd.run_trial(m, 640.0, arena, seed=1, trial=3, watch=[watch], every=4.0)
    values = inside.values[watch]
    np.testing.assert_allclose(values, outside.values[watch], atol=2e-4)
    assert np.ptp(values[32:], axis=0).max() > 1e-3  # readings change
