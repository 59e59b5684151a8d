"""The reward gate: when it is open, and its output."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.learning import RewardGate
from deodar.elements.stimuli import Boost
from tests.contracts.timed import RISING, alone

X = dd.Axis("x", 0, 10, 10, periodic=True)


def opened(windows, gate=None, height=0.2, **parameters):
    """Return the gate's output at every step of 0.5; the reward is homogeneous, its integral 10 times its
    height.
    """
    m = dd.Model("reward", dt=0.5)
    g = m.add(RewardGate(name="g", gated=gate is not None, **parameters))
    m.connect(m.add(Boost("reward", [X], height, windows=windows)), g["input"])
    if gate is not None:
        m.connect(m.add(Boost("arrived", [], 1.0, windows=gate)), g["gate"])
    return dd.simulate(m, 20, record=["g.output"], precision="float64")["g.output"].values


def times(*spans):
    t = np.arange(0, 20.25, 0.5)
    return np.any([(t >= a) & (t < b) for a, b in spans], axis=0).astype(float)


def test_the_gate_is_open_while_the_reward_lasts():
    assert np.array_equal(opened([(3, 5), (8, 9)]), times((3, 5), (8, 9)))
    assert not opened([(3, 5)], threshold=2.5).any()


@pytest.mark.parametrize("lasts", [0.5, 2.0, 4.0, 9.0])
def test_a_duration_opens_the_gate_for_that_time_from_the_onset(lasts):
    assert np.array_equal(opened([(3, 3 + lasts)], duration=4.0), times((3, 7)))


def test_a_new_onset_opens_the_gate_again():
    assert np.array_equal(opened([(3, 4), (5, 6), (12, 13)], duration=4.0), times((3, 9), (12, 16)))


def test_a_graded_gate_follows_the_reward_while_open():
    np.testing.assert_allclose(
        opened([(3, 9)], duration=4.0, graded=True, strength=0.5), times((3, 7)), atol=1e-12
    )
    np.testing.assert_allclose(opened([(3, 5)], graded=True, height=0.3), 3.0 * times((3, 5)), atol=1e-12)


def test_reward_opens_the_gate_only_while_its_gate_input_is_on():
    assert np.array_equal(opened([(2, 10)], gate=[(4, 6)]), times((4, 6)))
    assert not opened([(2, 4)], gate=[(4, 6)]).any()


def timed(t0: float) -> dd.Model:
    return alone(RewardGate(duration=4.0, name="example"), t0, (RISING == 3) * 1.0)


def lasting(duration: float) -> dd.Model:
    return alone(RewardGate(duration=duration, name="example"), given=(RISING == 0) * 1.0)
