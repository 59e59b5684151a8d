"""Registered worlds: readings have the declared shape, resets repeat them, and unknown names are refused."""

from __future__ import annotations

import functools
import json

import numpy as np
import pytest

import deodar as dd
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import WorldError
from deodar.kind_rules.check_kind import world_readings
from deodar.numerics.axes import Axis
from deodar.session.port_reader import port_reader
from deodar.worlds._base import World
from deodar.worlds._pure import PureWorld
from tests.contracts.embodied import WORLDS, everything, example_axes, step_of


@functools.cache
def shared(kind: str) -> World:
    """Return a world of a kind, the same one for all tests that reset it: its sensors compile once."""
    return WORLDS[kind].example()


@pytest.mark.parametrize("kind", WORLDS)
def test_every_sensor_reads_its_axes(kind):
    assert shared(kind).sensors
    assert [*world_readings(WORLDS[kind])] == []


@pytest.mark.parametrize("kind", WORLDS)
def test_sensors_read_together_have_the_readings_of_each_alone(kind):
    world = shared(kind)
    world.reset(3, [0, 5])
    requests = [(sensor, example_axes(kind, sensor)) for sensor in world.sensors]
    for (sensor, axes), reading in zip(requests, world.sense_all(requests, 0.0), strict=True):
        np.testing.assert_allclose(reading, world.sense(sensor, axes, 0.0), rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("kind", WORLDS)
def test_a_sensor_of_the_example_has_a_varying_reading(kind):
    world = shared(kind)
    world.reset(3)
    times = (0.0, world.period or 0.0)
    assert any(np.ptp(world.sense(s, example_axes(kind, s), t)) > 0 for s in world.sensors for t in times)


@pytest.mark.parametrize("kind", WORLDS)
def test_the_scene_lies_inside_its_border(kind):
    world = WORLDS[kind].example()
    world.reset(3)
    scene = world.scene()
    if scene is None:
        with pytest.raises(WorldError):
            world.move("anything", (0.0, 0.0))
        return
    left, low, right, high = scene.border
    assert all(type(edge) is float for edge in scene.border), "the page reads plain numbers"
    assert left < right and low < high and scene.bodies
    for body in scene.bodies:
        assert left <= body.center[0] <= right and low <= body.center[1] <= high and body.radius > 0
    json.dumps([[*box.center, *box.size, *box.color] for box in scene.boxes])
    for name in [box.name for box in scene.boxes]:
        assert scene.entry(name).name == name


@pytest.mark.parametrize("kind", WORLDS)
def test_a_sensor_in_a_model_has_the_reading_of_the_world(kind):
    world = shared(kind)
    for sensor, signal in world.sensors.items():
        axes = example_axes(kind, sensor)
        model = dd.Model("sensing")
        model.add(Sensor("eye", axes, sensor))
        session = dd.Session(model, world=world)
        reading = session.read("eye")
        read = np.asarray(world.sense(sensor, axes, 0.0))
        np.testing.assert_allclose(reading, read[0] if signal.each else read, rtol=1e-6)


@pytest.mark.parametrize(
    ("kind", "precision"),
    [*((kind, "float32") for kind in WORLDS), ("Eye", "float64"), ("MuJoCo", "float64")],
)
def test_a_run_is_independent_of_chunks_and_equal_after_a_reset(kind, precision):
    """The world sets the times of the exchange; neither chunks nor readings of the model change it."""
    model, dt = everything(kind), step_of(kind)
    paths = [f"{dd.quote(e.path)}.output" for e in model.document.entries]
    whole = dd.simulate(
        model, 24 * dt, dt=dt, record=paths, world=WORLDS[kind].example(), precision=precision
    )
    cut = dd.Session(model, dt=dt, world=WORLDS[kind].example(), precision=precision)
    places = [(e.id, "output") for e in model.document.entries]
    reader = port_reader(cut.program, places)  # one program; `read` compiles one for each port
    for _ in range(2):
        seen = [cut.read_ports(reader, places)]
        for n in [1, 2, 3, 1, 5, 12]:
            cut.step(n)
            seen.append(cut.read_ports(reader, places))
        at = np.cumsum([0, 1, 2, 3, 1, 5, 12])
        for path, place, variable in zip(paths, places, whole.data_vars.values(), strict=True):
            assert np.array_equal(variable.values[at], [now[place] for now in seen]), path
        cut.reset()


@pytest.mark.parametrize(
    ("kind", "precision", "tolerance"),
    [
        *((kind, "float64", 1e-10) for kind, cls in WORLDS.items() if issubclass(cls, PureWorld)),
        ("Eye", "float32", 1e-4),
    ],
)
def test_the_run_inside_the_step_equals_that_outside_of_it(kind, precision, tolerance):
    model, dt = everything(kind), step_of(kind)
    paths = [f"{dd.quote(e.path)}.output" for e in model.document.entries]
    inside, beside = WORLDS[kind].example(), WORLDS[kind].example()
    beside.inside = False
    options = dict(dt=dt, record=paths, precision=precision, seed=4)
    a, b = (dd.simulate(model, 40 * dt, world=world, **options) for world in (inside, beside))
    for path in a.data_vars:
        np.testing.assert_allclose(a[path].values, b[path].values, atol=tolerance, rtol=tolerance)
    batch = dd.simulate(model, 40 * dt, world=WORLDS[kind].example(), trials=[0, 3], **options)
    for path in a.data_vars:
        np.testing.assert_allclose(batch[path].values[0], b[path].values, atol=tolerance, rtol=tolerance)
        if "infrared" in path:
            assert np.abs(batch[path].values[0] - batch[path].values[1]).max() > 1e-3


@pytest.mark.parametrize("kind", WORLDS)
def test_a_snapshot_inside_a_period_is_restored(kind):
    model, dt = everything(kind), step_of(kind)
    paths = [f"{dd.quote(e.path)}.output" for e in model.document.entries if isinstance(e.element, Sensor)]
    session = dd.Session(model, dt=dt, world=WORLDS[kind].example())
    session.step(5)
    snapshot = session.snapshot()

    def onward():
        out = []
        for _ in range(9):
            out.append([session.read(path).tolist() for path in paths])
            session.step()
        return out

    first = onward()
    session.restore(snapshot)
    assert onward() == first


@pytest.mark.parametrize("kind", WORLDS)
def test_unknown_sensors_and_motors_are_refused_by_name(kind):
    world = WORLDS[kind].example()
    name = next(iter(world.sensors))
    with pytest.raises(WorldError, match=f"{name}x"):
        world.require(f"{name}x")
    model = dd.Model("sensing")
    model.add(Sensor("eye", example_axes(kind, name), f"{name}x"))
    with pytest.raises(WorldError, match=name):
        dd.Session(model, world=world)
    with pytest.raises(WorldError, match="eye"):
        dd.Session(model)
    moving = dd.Model("moving")
    moving.add(Motor("leg", [], "no such motor"))
    with pytest.raises(WorldError, match="has no motor 'no such motor'") as caught:
        dd.Session(moving, world=world)
    assert all(motor in str(caught.value) for motor in world.motors)


SHAPED = [
    (kind, sensor)
    for kind, cls in WORLDS.items()
    for sensor, signal in cls.example().sensors.items()
    if signal.shape is not None
]


@pytest.mark.parametrize(("kind", "sensor"), SHAPED)
def test_axes_that_a_sensor_does_not_have_are_refused(kind, sensor):
    model = dd.Model("sensing")
    model.add(Sensor("eye", [Axis("strange", 0, 1, 17)], sensor))
    with pytest.raises(WorldError, match=f"eye: '{sensor}' has .* the model gives it \\[17\\]"):
        dd.Session(model, world=WORLDS[kind].example())


def test_two_elements_cannot_drive_one_motor():
    model = dd.Model("moving")
    model.add(Motor("one", [], "left"))
    model.add(Motor("other", [], "left"))
    with pytest.raises(WorldError, match=r"drives the motor 'left', which (one|other) drives"):
        dd.Session(model)
