"""Everything registered as a world: readings of the right shape, the same again after a reset, and clear refusals."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.elements.sensor import Sensor
from deodar.errors import WorldError
from deodar.numerics.axes import shape

WORLDS = registry.kinds("worlds")


@pytest.mark.parametrize("kind", WORLDS)
def test_every_sensor_reads_its_axes(kind):
    world = WORLDS[kind].example()
    axes = WORLDS[kind].example_axes()
    assert world.sensors
    for sensor in world.sensors:
        world.reset(3)
        first = np.asarray(world.sense(sensor, axes, 0.0))
        assert first.shape == shape(axes) and np.isfinite(first).all() and np.ptp(first) > 0
        world.reset(3)
        assert np.array_equal(world.sense(sensor, axes, 0.0), first)


@pytest.mark.parametrize("kind", WORLDS)
def test_a_sensor_in_a_model_shows_what_the_world_reads(kind):
    world, axes = WORLDS[kind].example(), WORLDS[kind].example_axes()
    for sensor in world.sensors:
        model = dd.Model("sensing")
        model.add(Sensor("eye", axes, sensor))
        session = dd.Session(model, world=world)
        session.step(2)
        np.testing.assert_allclose(session.read("eye"), world.sense(sensor, axes, 0.0), rtol=1e-6)


@pytest.mark.parametrize("kind", WORLDS)
def test_a_record_can_keep_a_description(kind):
    said = WORLDS[kind].example().describe()
    assert said["world"] == kind and json.loads(json.dumps(said)) == said


@pytest.mark.parametrize("kind", WORLDS)
def test_unknown_sensors_are_refused_by_name(kind):
    world = WORLDS[kind].example()
    name = next(iter(world.sensors))
    with pytest.raises(WorldError, match=f"{name}x"):
        world.require(f"{name}x")
    model = dd.Model("sensing")
    model.add(Sensor("eye", WORLDS[kind].example_axes(), f"{name}x"))
    with pytest.raises(WorldError, match=name):
        dd.Session(model, world=world)
    with pytest.raises(WorldError, match="eye"):
        dd.Session(model)
