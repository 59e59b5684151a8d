"""Limits and rates of change from period to period, and the state that a snapshot keeps of them."""

from __future__ import annotations

import numpy as np

from deodar.worlds._base import Signal
from deodar.worlds._motor_rule import MotorRule
from deodar_robots.motor_limiter import MotorLimiter

MOTORS = {"fast": Signal("speed", ()), "slow": Signal("speed", (2,))}
RULES = {"slow": MotorRule(limits=(-5.0, 5.0), slew=100.0)}


def limiter(copies: int = 1) -> MotorLimiter:
    made = MotorLimiter(MOTORS, RULES)
    made.begin(copies)
    return made


def test_a_command_grows_by_its_rate_of_change_from_rest_to_its_limit():
    made, expected = limiter(), np.full((1, 2), 9.0, np.float32)
    found = [float(made.allowed("slow", expected, 20.0)[0, 0]) for _ in range(4)]
    assert found == [2.0, 4.0, 5.0, 5.0]
    made.rest("slow")
    assert float(made.allowed("slow", expected, 20.0)[0, 0]) == 2.0
    made.rest()
    assert float(made.allowed("slow", expected, 20.0)[0, 0]) == 2.0
    assert float(made.allowed("fast", np.array([99.0]), 20.0)[0]) == 99.0


def test_what_is_kept_has_one_form_and_leads_to_the_same_commands():
    made, reference = limiter(3), np.full((3, 2), -9.0)
    start = made.keep()
    assert {motor: value.shape for motor, value in start.items()} == {"fast": (3,), "slow": (3, 2)}
    made.allowed("slow", reference, 20.0)
    middle = made.keep()
    assert middle["slow"].shape == (3, 2)
    expected = made.allowed("slow", reference, 20.0)
    other = limiter(3)
    other.put(middle)
    assert (other.allowed("slow", reference, 20.0) == expected).all()
    other.put(start)
    assert float(other.allowed("slow", reference, 20.0)[0, 0]) == -2.0
