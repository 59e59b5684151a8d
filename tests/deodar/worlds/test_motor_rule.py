"""The rule of a motor: limits, the largest change, and rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deodar.errors import WorldError
from deodar.worlds._motor_rule import MotorRule

FINITE = st.floats(-1e6, 1e6, width=32)


@given(FINITE, FINITE, st.floats(0.1, 1e3), st.floats(1, 1e3))
def test_commands_stay_within_limits_and_change_slowly_enough(command, before, slew, period):
    rule = MotorRule((-50.0, 50.0), slew)
    last = np.clip(np.array([before], np.float32), -50, 50)
    [allowed] = rule.allowed(np.array([command], np.float32), last, period)
    assert -50 <= allowed <= 50
    assert abs(float(allowed) - float(last[0])) <= slew * period / 1000 * (1 + 1e-5) + 1e-4


def test_a_rule_without_limits_changes_no_bit_and_no_type():
    for dtype in (np.float32, np.float64):
        command = np.random.default_rng(0).standard_normal((2, 3)).astype(dtype)
        assert MotorRule().allowed(command, None, 10.0) is command
        assert MotorRule((-1.0, 1.0), 2.0).allowed(command, None, 10.0).dtype == dtype


def test_the_first_command_changes_from_rest():
    rule = MotorRule(slew=100.0, rest=3.0)
    assert rule.allowed(np.array([9.0]), None, 10.0).tolist() == [4.0]
    assert rule.at_rest(np.zeros((1, 2))).tolist() == [[3.0, 3.0]]


def test_a_rule_is_read_as_it_is_written_and_bad_ones_are_refused():
    rule = MotorRule((-1.0, 2.0), 5.0, 0.5, 100.0)
    assert MotorRule.from_data(rule.to_data(), "m") == rule
    assert MotorRule.from_data({}, "m") == MotorRule()
    for record in (
        {"limits": [1]},
        {"limits": [2, 1]},
        {"limits": [0, float("inf")]},
        {"limits": "wide"},
        {"limits": 3},
        {"slew": -1},
        {"slew": "fast"},
        {"rest": float("nan")},
        {"stops_after": 0},
        {"limits": [1, 2]},
    ):
        with pytest.raises(WorldError, match=r"^m: "):
            MotorRule.from_data(record, "m")


@pytest.mark.parametrize(
    ("limits", "slew", "expected"),
    [
        ((-9.0, 1.0), None, MotorRule((-2.0, 1.0), 5.0)),
        ((-9.0, 9.0), 7.0, MotorRule((-2.0, 3.0), 5.0)),
        (None, 4.0, MotorRule((-2.0, 3.0), 4.0)),
        ((-1.0, 1.0), 4.0, MotorRule((-1.0, 1.0), 4.0)),
    ],
)
def test_a_rule_becomes_narrower_and_never_wider(limits, slew, expected):
    assert MotorRule((-2.0, 3.0), 5.0).within(limits, slew) == expected


def test_a_rule_without_limits_gets_those_that_are_stated():
    assert MotorRule().within((-1.0, 1.0), 2.0) == MotorRule((-1.0, 1.0), 2.0)
    assert MotorRule(rest=4.0).within() == MotorRule(rest=4.0)


def test_two_narrowings_of_one_motor_both_hold():
    rule = MotorRule((-5.0, 5.0)).within((-1.0, 9.0)).within((-3.0, 2.0), 4.0).within(slew=8.0)
    assert rule == MotorRule((-1.0, 2.0), 4.0)


@pytest.mark.parametrize(
    ("limits", "slew", "message"),
    [
        ((4.0, 6.0), None, "left: no value lies within both -2 to 3 and 4 to 6"),
        ((1.0, 2.0), None, "left: rest is 0; expected a value within the limits 1 to 2"),
        (None, 0.0, "left: the change a second is 0; expected a number above 0"),
        ((-1.0, 1.0), -2.0, "left: the change a second is -2; expected a number above 0"),
        ((1.0, -1.0), None, "left: no value lies within both"),
    ],
)
def test_a_rule_that_leaves_no_command_is_refused(limits, slew, message):
    with pytest.raises(WorldError, match=message):
        MotorRule((-2.0, 3.0)).within(limits, slew, "left")
