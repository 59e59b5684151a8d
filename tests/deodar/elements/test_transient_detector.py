"""The transient detector: pulses at changes, by closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.changing_stimuli import TimeSeries
from deodar.elements.populations import TransientDetector

X = dd.Axis("x", 0, 2, 3)
DT, TAU = 0.5, 20.0


def seen(times, values, interpolation="hold", initial=0.0):
    model = dd.Model("changes", dt=DT)
    source = model.add(
        TimeSeries("s", [X], times, np.multiply.outer(values, [1.0, -2.0, 0.0]), interpolation=interpolation)
    )
    source >> model.add(TransientDetector("detector", [X], tau=TAU, initial=initial))
    record = dd.simulate(model, 200, record=["detector.output", "detector.off"], precision="float64")
    return record["time"].values, record["detector.output"].values, record["detector.off"].values


def test_steps_up_and_down_give_decaying_pulses():
    t, on, off = seen([0, 40, 120], [0.0, 3.0, 1.0])
    passed = np.maximum(np.round((t - 40) / DT), 0)
    pulse = np.where(t >= 40, 3.0 * (1 - DT / TAU) ** passed, 0.0)
    before = t < 120
    np.testing.assert_allclose(on[before, 0], pulse[before], atol=1e-12)
    np.testing.assert_allclose(off[before, 1], 2 * pulse[before], atol=1e-12)
    assert not off[before, 0].any() and not on[before, 1].any() and not on[:, 2].any() and not off[:, 2].any()
    # the decrease is what the slow copy still contains
    slow = 3.0 - pulse[t == 120][0]
    np.testing.assert_allclose(
        off[~before, 0], (slow - 1.0) * (1 - DT / TAU) ** np.round((t[~before] - 120) / DT), atol=1e-12
    )


def test_a_linear_rise_gives_its_slope_times_tau():
    _, on, _ = seen([0, 1000], [0.0, 100.0], interpolation="linear")
    assert on[-1, 0] == pytest.approx(0.1 * TAU, rel=1e-4)


def test_an_initial_value_equal_to_the_input_gives_no_pulse():
    _, on, off = seen([0], [4.0], initial=4.0)
    assert not on[:, 0].any() and not off[:, 0].any() and off[0, 1] == pytest.approx(12.0)
