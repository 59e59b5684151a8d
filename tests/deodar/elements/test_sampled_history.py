"""A history at given times."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.memories import SampledHistory
from tests.contracts.timed import RISING, alone

X = dd.Axis("x", 0, 3, 4)


@pytest.mark.parametrize("empty", ["zero", "nan"])
def test_each_slot_contains_the_input_at_its_time(empty):
    model = dd.Model("moments", dt=0.5)
    u = model.add(dd.Field("u", [X], tau=10, resting_level=-3))
    model.connect(model.add(dd.GaussianStimulus("s", [X], center=1, sigma=1, amplitude=9)), u)
    times = [2.0, 0.0, 3.1, 99.0]
    past = model.add(SampledHistory("past", [X], dd.Axis("slot", 0, 3, 4), times, empty))
    model.connect(u, past, reads="current")
    record = dd.simulate(model, 5, record=["u.output", "past.output"], precision="float64")
    g, samples = record["u.output"].values, record["past.output"].values
    nothing = np.full(4, np.nan if empty == "nan" else 0.0)
    for k in range(11):
        expected = [g[4] if k >= 4 else nothing, nothing, g[6] if k >= 6 else nothing, nothing]
        assert np.array_equal(samples[k], expected, equal_nan=True)


def test_a_time_for_each_slot_is_required():
    model = dd.Model("lengths")
    model.connect(
        model.add(dd.Field("u", [X])),
        model.add(SampledHistory("past", [X], dd.Axis("slot", 0, 3, 4), [1.0, 2.0])),
    )
    assert any("times has shape [2], the axis of the slots has 4 samples" in p.what for p in model.check())


def test_the_slots_need_a_name_of_their_own():
    model = dd.Model("names")
    model.connect(
        model.add(dd.Field("u", [X])), model.add(SampledHistory("past", [X], dd.Axis("x", 0, 2, 3)))
    )
    assert any("slots are called 'x'" in p.what for p in model.check())


def timed(t0: float) -> dd.Model:
    times = t0 + np.array([2.0, 5.0, 9.0])
    return alone(SampledHistory("example", [], dd.Axis("slot", 0, 2, 3), times), t0, RISING)
