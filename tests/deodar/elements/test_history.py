"""The running history."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.memories import History
from deodar.errors import NotFinite
from tests.contracts.timed import RISING, alone

X = dd.Axis("x", 0, 3, 4)


@pytest.mark.parametrize(("dt", "interval"), [(1.0, 1.0), (1.0, 3.0), (0.5, 2.0), (0.1, 0.3), (2.0, 0.5)])
def test_the_latest_time_comes_first(dt, interval):
    model = dd.Model("history", dt=dt)
    u = model.add(dd.Field("u", [X], tau=10, resting_level=-3))
    model.connect(u, model.add(History("past", [X], dd.Axis("slot", 0, 2, 3), interval)))
    record = dd.simulate(model, 12, record=["u.output", "past.output"], precision="float64")
    g, past = record["u.output"].values, record["past.output"].values
    kept = np.zeros((3, 4))
    for k in range(len(g)):
        assert np.array_equal(past[k], kept)
        turn = (k + 1) * dt / interval
        if abs(turn - round(turn)) * interval < dt / 2:
            kept = np.vstack([g[k][None], kept[:-1]])
    assert past[-1].all()


def test_the_slots_need_a_name_of_their_own():
    model = dd.Model("names")
    model.connect(model.add(dd.Field("u", [X])), model.add(History("past", [X], dd.Axis("x", 0, 2, 3))))
    assert any("slots are called 'x'" in p.what for p in model.check())


def test_empty_slots_may_be_undefined():
    model = dd.Model("nan")
    u = model.add(dd.Field("u", [X], tau=10, resting_level=-3))
    model.connect(u, model.add(History("past", [X], dd.Axis("slot", 0, 2, 3), 2.0, "nan")))
    past = dd.simulate(model, 8, record=["past.output"])["past.output"].values
    assert [int(np.isnan(moment).all(axis=1).sum()) for moment in past] == [3, 3, 2, 2, 1, 1, 0, 0, 0]
    assert not np.isnan(past[:, 0, 0]).all() and not np.isnan(past[-1]).any()


def test_a_reader_of_an_undefined_slot_is_named_in_the_error():
    model = dd.Model("spoilt")
    u = model.add(dd.Field("u", [X], tau=10, resting_level=-3))
    past = model.add(History("past", [X], dd.Axis("slot", 0, 2, 3), 2.0, "nan"))
    u >> past >> dd.Gain(1.0, name="twice")
    with pytest.raises(NotFinite, match=r"twice\.output became infinite or undefined"):
        dd.simulate(model, 3, record=["twice.output"])


def timed(t0: float) -> dd.Model:
    return alone(History("example", [], dd.Axis("slot", 0, 2, 3), interval=3.0), t0, RISING)


def lasting(duration: float) -> dd.Model:
    return alone(History("example", [], dd.Axis("slot", 0, 2, 3), interval=duration), given=RISING + 5)
