"""What follows from pictures is computed when a picture or a parameter is new, and always equals the rest."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal, World

AXES = [dd.Axis("x", 0, 79, 80), dd.Axis("y", 0, 59, 60), dd.Axis("channel", 0, 2, 3)]
SMALL = [dd.Axis("x", 1.5, 77.5, 20), dd.Axis("y", 1.5, 57.5, 15), dd.Axis("hue", 0, 360, 12, periodic=True)]


class Film(World):
    """A picture that is new at every third exchange, and a number that is new at each."""

    sensors = {"picture": Signal("colours"), "count": Signal("exchanges", ())}
    period = 2.0
    tick = 0

    def reset(self, seed, trials=(0,), precision="float32"):
        self.tick = 0

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        if sensor == "count":
            return np.asarray(float(self.tick))
        return np.random.default_rng(self.tick // 3).random([a.samples for a in axes])

    def act(self, motors, time):
        self.tick += 1

    def keep(self):
        return np.asarray(self.tick)

    def put(self, kept):
        self.tick = int(kept)


def film_model() -> dd.Model:
    model = dd.Model("film", dt=1.0)
    eye = model.add(dd.Sensor("eye", AXES, "picture"))
    colours = model.add(dd.ColorSpace(SMALL, sigma=30.0, name="colours"))
    field = model.add(dd.Field("field", SMALL, tau=10.0))
    eye >> colours >> model.add(dd.Gain(2.0, name="gain")) >> field
    model.add(dd.Sensor("count", [], "count")) >> model.add(dd.Field("node", [], tau=5.0))
    return model


def looks(session: dd.Session, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    program, done = session.program, []
    look = program.look
    monkeypatch.setattr(program, "look", lambda *a: done.append(session.tick) or look(*a))
    return done


def test_it_is_computed_once_for_each_picture(monkeypatch):
    session = dd.Session(film_model(), world=Film())
    done = looks(session, monkeypatch)
    session.step(20)
    assert len(done) == 4, "pictures at 0, 6, 12 and 18 ms"


def test_every_value_is_that_of_a_program_that_computes_it_in_each_chunk():
    model, record = film_model(), ["colours", "field.activation", "node.activation"]
    options = dict(record=record, every=1, world=Film())
    recorded = dd.simulate(model, 24, **options)
    swept = dd.simulate(model, 24, sweep={"gain.factor": [2.0]}, **options)
    for name in recorded.data_vars:
        np.testing.assert_allclose(recorded[name].values, swept[name].values[0], atol=1e-6)
    assert np.ptp(recorded["field.activation"].values[-1]) > 0.1


def test_a_changed_parameter_and_a_restored_moment_are_seen_at_once(monkeypatch):
    session = dd.Session(film_model(), world=Film())
    session.step(7)
    snapshot, before = session.snapshot(), np.asarray(session.read("colours"))
    session.set("colours.sigma", 60.0)
    wide = np.asarray(session.read("colours"))
    assert not np.allclose(wide, before)
    session.step(6)
    assert not np.allclose(session.read("colours"), wide), "another picture"
    session.restore(snapshot)
    np.testing.assert_array_equal(session.read("colours"), before)
