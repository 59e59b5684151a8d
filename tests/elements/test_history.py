"""The running history."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.history import History

X = dd.Axis("x", 0, 3, 4)


@pytest.mark.parametrize(("dt", "interval"), [(1.0, 1.0), (1.0, 3.0), (0.5, 2.0), (0.1, 0.3), (2.0, 0.5)])
def test_the_newest_moment_comes_first(dt, interval):
    model = dd.Model("history", dt=dt)
    u = model.add(dd.Field("u", [X], tau=10, resting_level=-3))
    model.connect(u, model.add(History("past", [X], dd.Axis("slot", 0, 2, 3), interval)))
    data = dd.simulate(model, 12, record=["u.output", "past.output"], precision="float64")
    g, past = data["u.output"].values, data["past.output"].values
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
