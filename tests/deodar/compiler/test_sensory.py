"""What follows from readings of a world alone is computed when the world is read, not at every step."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.session.exchange import embodied
from tests.deodar.compiler.programs import executable
from tests.deodar.experiments.calls import run_alone, run_together

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
    m, arena = _model(), dd.Arena("blocks", noise=dd.ArenaNoise(infrared_noise=1.0, slip=0.1))
    arena.place("visitor", (0.9, 0.6), (0.1, 0.1), windows=(200.0, 400.0))
    [inside] = run_together(m, 640.0, [3], [watch], world=arena, seed=1, every=4.0)
    outside = run_alone(m, 640.0, arena, seed=1, trial=3, watch=[watch], every=4.0)
    values = inside.values[watch]
    np.testing.assert_allclose(values, outside.values[watch], atol=2e-4)
    assert np.ptp(values[32:], axis=0).max() > 1e-3  # readings change


def test_a_sensor_of_a_longer_period_has_couplings_of_that_period() -> None:
    """The histogram follows from the camera alone; the product reads the infrared sensors, too."""
    hue, column = dd.Axis("hue", 0, 360, 12, periodic=True), dd.Axis("column", 0, 11, 12)
    m = dd.Model("eye", dt=5)
    camera = dd.Sensor("eye", [column, dd.Axis("row", 0, 8, 9), dd.Axis("rgb", 0, 2, 3)], sensor="camera")
    m.add(camera) >> m.add(dd.ColorHistogram([column, hue], name="colours"))
    m.add(dd.Sensor("distance", [dd.Axis("of", 0, 5, 6)], sensor="infrared")) >> m.add(
        dd.Project([], reduce="min", name="nearest")
    )
    m["colours"] >> m.add(dd.Product(name="product"))
    m.connect("nearest", "product.factor")
    m["product"] >> m.add(dd.Field("u", [column, hue], resting_level=-1.0))
    for side, speed in (("left", 200.0), ("right", 400.0)):
        m.add(dd.Boost(f"speed {side}", [], speed)) >> m.add(dd.Motor(side, motor=side))
    layout = {
        "unit": "mm",
        "arena": {"x": [-300, 300], "y": [-300, 300]},
        "blocks": [{"name": "red", "center": [100, 40], "size": [50, 50], "color": [1, 0, 0]}],
    }
    arena = dd.Arena(
        layout, (0, 0, 0), unit="mm", vehicle="khepera", physics=dd.ArenaPhysics(period=20, camera_every=4)
    )
    body = embodied(m.document, arena)
    program = executable(m, body=body).program
    paths = {
        n: [program.plan.groups[c.group].like.path for c in program.sensory_calls[n]]
        for n in program.sensory_calls
    }
    assert paths[4] == ["colours"] and {"nearest", "product"} <= set(paths[1])
    watch = ["colours.output", "product.output", "u.activation"]
    [inside] = run_together(m, 800.0, [0], watch, world=arena, every=5.0)
    outside = run_alone(m, 800.0, arena, watch=watch, every=5.0)
    for name in watch:
        np.testing.assert_allclose(inside.values[name], outside.values[name], rtol=2e-4, atol=2e-4)
    changes = np.abs(np.diff(inside.values["colours.output"], axis=0)).sum((1, 2)) > 0
    assert changes.any() and not changes[np.arange(len(changes)) % 16 != 15].any()
