"""A model as the world of another one: two halves compute what the whole computes."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.cli import main
from deodar.errors import ModelError, WorldError
from deodar.session.model_world import ModelWorld
from deodar_robots.zenoh.served_world import ServedWorld

LINE = [dd.Axis("x", 0, 30, 31)]


def field(name: str) -> dd.Field:
    kernel = [dd.Gaussian(1.5, 3)]
    return dd.Field(name, LINE, resting_level=-3, kernel=kernel, global_inhibition=0.3, noise=0.5)


def stimulus() -> dd.GaussianStimulus:
    return dd.GaussianStimulus("stimulus", LINE, center=12, sigma=3, amplitude=6)


def whole() -> dd.Model:
    model = dd.Model("whole")
    a, b = model.add(field("a")), model.add(field("b"))
    model.add(stimulus()) >> a
    forth, back = model.add(dd.Gain(3.0, name="forth")), model.add(dd.Gain(0.5, name="back"))
    model.connect(a, forth, reads="delayed")
    model.connect(b, back, reads="delayed")
    forth >> b
    back >> a
    return model


def half(own: str, other: str, strength: float, name: str) -> dd.Model:
    model = dd.Model(own)
    u = model.add(field(own))
    model.add(dd.Sensor("get", LINE, other)) >> model.add(dd.Gain(strength, name=name)) >> u
    u >> model.add(dd.Motor("send", LINE, own))
    return model


def halves() -> tuple[dd.Model, dd.Model]:
    first, second = half("a", "b", 0.5, "back"), half("b", "a", 3.0, "forth")
    first.connect(first.add(stimulus()), "a")
    return first, second


@pytest.mark.parametrize("remote", [False, True])
def test_two_halves_compute_the_whole_with_delayed_connections(remote):
    first, second = halves()
    inside = ModelWorld(second)
    served = ServedWorld(inside, "second") if remote else None
    world = dd.Zenoh(at=served.endpoint) if served else inside
    expected = dd.Session(whole(), seed=7, precision="float64")
    session = dd.Session(first, world=world, seed=7, precision="float64")
    for _ in range(200):
        session.step()
        expected.step()
        for name, found in (("a", session), ("b", inside.session)):
            np.testing.assert_allclose(found.read(name), expected.read(name), atol=1e-10)
    assert expected.read("b").max() > 1, "the second field has a peak, which the first one caused"
    if served:
        world.close()
        served.close()


def test_a_model_that_nothing_can_reach_is_refused():
    alone = dd.Model("alone")
    alone.add(field("a"))
    with pytest.raises(ModelError, match="no sensor and no motor"):
        ModelWorld(alone)
    model = dd.Model("both")
    model.add(dd.Sensor("one", LINE, "a"))
    model.add(dd.Sensor("two", [dd.Axis("x", 0, 30, 16)], "a"))
    with pytest.raises(ModelError, match="two: reads 'a' over other axes than one"):
        ModelWorld(model)
    with pytest.raises(WorldError, match="one trial at a time"):
        ModelWorld(halves()[1]).reset(0, [0, 1])


def test_the_command_needs_a_world_or_a_model(capsys):
    for call in (["serve"], ["serve", "arena:blocks", "--model", "example:selection"]):
        with pytest.raises(SystemExit):
            main(call)
        assert "serve needs a KIND:ARGUMENT or a --model" in capsys.readouterr().err
    assert main(["serve", "--model", "example:selection"]) == 1
    assert "no sensor and no motor" in capsys.readouterr().err
