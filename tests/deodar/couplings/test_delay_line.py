"""The delay line: its output is the delayed input, for any delay, step and number of slots."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.delays import Delay, DelayLine
from deodar.elements.changing_stimuli import TimeSeries
from tests.contracts.timed import RISING, alone

X = dd.Axis("x", 0, 2, 3)


def late(delay, dt, slots=100, duration=60.0, precision="float64", smooth=False, **values):
    """Return times, input and output."""
    model = dd.Model("late", dt=dt)
    t = np.arange(0, duration + dt, 1.0 if smooth else dt)
    signal = (
        np.sin(t / 9)[:, None] * [1.0, 2.0, -1.0]
        if smooth
        else np.random.default_rng(2).normal(size=(len(t), 3))
    )
    source = model.add(TimeSeries("s", [X], t, signal))
    source >> model.add(DelayLine("line", [X], delay, slots, **values))
    record = dd.simulate(model, duration, record=["s.output", "line.output"], precision=precision)
    return record["time"].values, record["s.output"].values, record["line.output"].values


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize(
    ("delay", "dt", "slots"),
    [(1.0, 1.0, 1), (7.0, 1.0, 7), (7.0, 1.0, 100), (0.6, 0.02, 30), (0.3, 0.1, 100), (25.0, 0.5, 50)],
)
def test_a_delay_of_a_whole_number_of_steps_is_exact(delay, dt, slots, precision):
    _, s, y = late(delay, dt, slots, precision=precision, initial=0.7)
    n = round(delay / dt)
    np.testing.assert_array_equal(y[n:], s[:-n])
    assert (y[:n] == np.float32(0.7) if precision == "float32" else y[:n] == 0.7).all()


def test_a_delay_between_two_steps_is_interpolated_linearly():
    _, s, y = late(2.25, 1.0)
    np.testing.assert_allclose(y[3:], 0.75 * s[1:-2] + 0.25 * s[:-3], atol=1e-12)


def test_with_fewer_slots_than_steps_the_interpolation_is_coarser():
    """Linear interpolation between samples h apart of a sine of frequency w has an error below (h w)^2 /
    8.
    """
    for slots in (4, 8, 16):
        t, _, y = late(16.0, 0.25, slots, smooth=True)
        after = t > 16 + 16 / slots
        wrong = abs(y[after, 0] - np.sin((t[after] - 16) / 9)).max()
        assert wrong < 1.1 * ((16 / slots) ** 2 + 1) / 81 / 8


def test_a_delay_shorter_than_a_step_equals_the_register():
    model = dd.Model("register", dt=1.0)
    u = model.add(dd.Field("u", [X], tau=5, noise=0.5))
    for delay in (Delay([X], 0.3, name="register"), DelayLine("line", [X], 0.01, 3, 0.3)):
        u >> model.add(delay)
    record = dd.simulate(model, 30, record=["register", "line"], precision="float64")
    np.testing.assert_array_equal(record["register.output"].values, record["line.output"].values)


def test_a_delay_can_be_increased_during_a_run():
    model = dd.Model("longer", dt=1.0)
    model.add(TimeSeries("s", [], [0, 1000], [0.0, 1000.0])) >> model.add(DelayLine("line", [], 5.0, 50))
    s = dd.Session(model, precision="float64")
    s.step(100)
    assert s.read("line.output") == pytest.approx(95)
    s.set("line.delay", 20.0)
    # 50 slots are more than the five steps that are needed
    assert s.read("line.output") == pytest.approx(80)
    s.set("line.delay", 200.0)
    oldest = float(s.read("line.output"))
    s.step(250)
    assert oldest < 60 and float(s.read("line.output")) == pytest.approx(150)


def timed(t0: float) -> dd.Model:
    return alone(DelayLine("example", [], 4.0, 4), t0, RISING)


def lasting(duration: float) -> dd.Model:
    return alone(DelayLine("example", [], duration, 2, initial=-1.0), given=RISING + 5)
